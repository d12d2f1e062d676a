#pragma once

#include <array>

#include "ebac/core/fields.hpp"

/// Who steers, by what, and where to.
namespace ebac::gastroscope {

/// The master: how the joystick's handle commands the slave, and what it is given back.
struct MasterParams {
  static constexpr int kPedals = 0, kSlideRate = 1, kSlideClutch = 2;

  bool bend_by_rate = false;
  int insertion = kSlideRate;
  double bend_scale = 50;       // rad/m
  double bend_rate = 40;        // rad/s/m
  double insertion_rate = 1.5;  // 1/s
  double insertion_scale = 1;   // m/m
  double dead_zone = 1e-3;      // m
  double feedback = 1;          // 1
  double push_scale = 1;        // 1
  double most_force = 20;       // N
  double delay = 0;             // s

  static constexpr auto fields() {
    using F = Field<MasterParams>;
    using P = MasterParams;
    return std::array{
        F{"bend_by_rate", &P::bend_by_rate, "1",
          "whether the handle's place is a rate of bending instead of a bend"},
        F{"insertion", &P::insertion, "1",
          "0 pedals, 1 third axis as a rate, 2 third axis as a place, with a clutch", 0, 2},
        F{"bend_scale", &P::bend_scale, "rad/m", "bend per way of the handle", 1, 500},
        F{"bend_rate", &P::bend_rate, "rad/(s m)", "rate of bending per way of the handle", 0.1,
          1e3},
        F{"insertion_rate", &P::insertion_rate, "1/s", "speed of insertion per way of the handle",
          0.01, 100},
        F{"insertion_scale", &P::insertion_scale, "1", "insertion per way of the handle", 0.01,
          100},
        F{"dead_zone", &P::dead_zone, "m", "way of the handle that is no rate", 0, 0.02},
        F{"feedback", &P::feedback, "1", "share of the slave's force that the handle gets; 0 none",
          0, 10},
        F{"push_scale", &P::push_scale, "1", "force at the third axis per force of insertion", 0,
          10},
        F{"most_force", &P::most_force, "N", "largest force asked of an axis of the handle", 0,
          100},
        F{"delay", &P::delay, "s", "of the line each way, picture and force alike", 0, 2},
    };
  }
};

/// The simulated physician: steers by the picture. All of it is assumed, but for the reaction time's
/// order of magnitude.
struct PhysicianParams {
  double reaction = 0.25;       // s
  double crossover = 0.35;      // 1
  double noise = 0.03;          // rad
  double hand_speed = 0.06;     // m/s
  double advance = 0.03;        // m/s
  double approach = 0.012;      // m/s
  double retreat = 0.02;        // m/s
  double look_ahead = 0.045;    // m
  double field_of_view = 2.44;  // rad
  double heed = 0;              // N
  double patience = 30;         // s

  static constexpr auto fields() {
    using F = Field<PhysicianParams>;
    using P = PhysicianParams;
    return std::array{
        F{"reaction", &P::reaction, "s", "from picture to hand", 0.02, 2},
        F{"crossover", &P::crossover, "1",
          "speed with which a bearing is corrected, times all delay: below 0.5 it does not swing",
          0.01, 1.5},
        F{"noise", &P::noise, "rad", "standard deviation of a bearing, in each picture", 0, 1},
        F{"hand_speed", &P::hand_speed, "m/s", "fastest motion of the hand", 1e-3, 2},
        F{"advance", &P::advance, "m/s", "speed of insertion along a clear lumen", 1e-3, 0.5},
        F{"approach", &P::approach, "m/s", "speed of insertion towards a target", 1e-3, 0.5},
        F{"retreat", &P::retreat, "m/s", "speed of withdrawal", 1e-3, 0.5},
        F{"look_ahead", &P::look_ahead, "m", "how far along the lumen it looks", 5e-3, 0.2},
        F{"field_of_view", &P::field_of_view, "rad", "of the camera", 0.5, 3.1},
        F{"heed", &P::heed, "N", "felt force at which it stops to advance; 0 heeds none", 0, 100},
        F{"patience", &P::patience, "s", "after which it leaves a target", 1, 600},
    };
  }
};

/// A target on the wall: a polyp.
struct Target {
  double place = 0.5;  // m
  double angle = 0;    // rad

  static constexpr auto fields() {
    using F = Field<Target>;
    return std::array{
        F{"place", &Target::place, "m", "along the lumen, from the teeth", 0, 1.2},
        F{"angle", &Target::angle, "rad", "around it, from the camera's right to its down", -6.3,
          6.3},
    };
  }
};

}  // namespace ebac::gastroscope
