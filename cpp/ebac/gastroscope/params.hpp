#pragma once

#include <array>

#include "ebac/core/fields.hpp"

namespace ebac::gastroscope {

/// The slave: a gastroscope whose insertion, rotation and two bending wheels are driven by motors.
/// Sources: `docs/explanation/gastroscope.md`.
struct ScopeParams {
  double diameter = 9.2e-3;          // m
  double section = 0.07;             // m
  double tip = 0.012;                // m
  double most_bend = 2.9;            // rad
  double bend_speed = 2;             // rad/s
  double insertion_speed = 0.08;     // m/s
  double rotation_speed = 3;         // rad/s
  double lag = 0.03;                 // s
  double most_torque = 0.6;          // N m
  double most_push = 15;             // N
  double backlash = 0.1;             // rad
  double hysteresis = 0.15;          // 1
  double hysteresis_width = 0.2;     // rad
  double bend_stiffness = 1;         // N m/rad
  double bend_damping = 0.05;        // N m s/rad
  double flexural_rigidity = 0.015;  // N m^2
  double axial_stiffness = 1500;     // N/m
  double axial_damping = 20;         // N s/m
  double friction = 0.1;             // 1

  static constexpr auto fields() {
    using F = Field<ScopeParams>;
    return std::array{
        F{"diameter", &ScopeParams::diameter, "m", "outer diameter", 1e-3, 0.02},
        F{"section", &ScopeParams::section, "m", "length of the bending section", 0.01, 0.2},
        F{"tip", &ScopeParams::tip, "m", "length of the stiff tip ahead of it", 0, 0.05},
        F{"most_bend", &ScopeParams::most_bend, "rad", "largest bend", 0.1, 4},
        F{"bend_speed", &ScopeParams::bend_speed, "rad/s", "largest speed of a bending motor", 0.01,
          50},
        F{"insertion_speed", &ScopeParams::insertion_speed, "m/s",
          "largest speed of the insertion motor", 1e-3, 1},
        F{"rotation_speed", &ScopeParams::rotation_speed, "rad/s",
          "largest speed of the rotation motor", 0.01, 50},
        F{"lag", &ScopeParams::lag, "s", "time constant of every motor's position loop", 1e-3, 1},
        F{"most_torque", &ScopeParams::most_torque, "N m",
          "load at which a bending motor stands still", 0.01, 10},
        F{"most_push", &ScopeParams::most_push, "N",
          "load at which the insertion motor stands still", 0.1, 100},
        F{"backlash", &ScopeParams::backlash, "rad",
          "slack of the tendons, from end to end, at the tip", 0, 1},
        F{"hysteresis", &ScopeParams::hysteresis, "1",
          "share of the bend that follows through friction in the sheaths", 0, 0.9},
        F{"hysteresis_width", &ScopeParams::hysteresis_width, "rad",
          "width of that friction, from end to end, at the tip", 0, 2},
        F{"bend_stiffness", &ScopeParams::bend_stiffness, "N m/rad",
          "of the section under a load, motors held", 0.05, 50},
        F{"bend_damping", &ScopeParams::bend_damping, "N m s/rad", "of the same", 1e-3, 10},
        F{"flexural_rigidity", &ScopeParams::flexural_rigidity, "N m^2",
          "E I of the insertion tube", 1e-4, 1},
        F{"axial_stiffness", &ScopeParams::axial_stiffness, "N/m",
          "of the insertion tube between motor and tip", 50, 1e5},
        F{"axial_damping", &ScopeParams::axial_damping, "N s/m", "of the same", 0.1, 1e3},
        F{"friction", &ScopeParams::friction, "1", "Coulomb's coefficient between tube and wall", 0,
          1},
    };
  }
};

/// The patient: measures of the lumen from the teeth to behind the pylorus, its wall and its motion.
struct PatientParams {
  double mouth = 0.07;              // m
  double pharynx = 0.1;             // m
  double oesophagus = 0.22;         // m
  double cardia = 0.03;             // m
  double stomach = 0.24;            // m
  double pylorus = 0.02;            // m
  double bulb = 0.04;               // m
  double pharynx_radius = 0.014;    // m
  double oesophagus_radius = 0.01;  // m
  double cardia_radius = 9e-3;      // m
  double stomach_radius = 0.038;    // m
  double pylorus_radius = 7e-3;     // m
  double throat_turn = 1.2;         // rad
  double cardia_turn = 0.6;         // rad
  double stomach_turn = 1.7;        // rad
  double stiffness = 800;           // N/m
  double damping = 2;               // N s/m
  double bag_stiffness = 400;       // N/m
  double bag_damping = 20;          // N s/m
  double peristalsis = 0.15;        // 1
  double peristalsis_speed = 0.03;  // m/s
  double peristalsis_period = 10;   // s
  double antral_depth = 0.25;       // 1
  double antral_speed = 2.5e-3;     // m/s
  double antral_period = 20;        // s
  double breathing = 0.01;          // m
  double breathing_rate = 0.25;     // Hz
  double force_limit = 6;           // N
  double perforation = 14.1;        // N

  static constexpr auto fields() {
    using F = Field<PatientParams>;
    using P = PatientParams;
    return std::array{
        F{"mouth", &P::mouth, "m", "straight way from the teeth to the pharynx", 0.01, 0.15},
        F{"pharynx", &P::pharynx, "m", "way from there to the oesophagus", 0.05, 0.3},
        F{"oesophagus", &P::oesophagus, "m", "length of the oesophagus", 0.1, 0.4},
        F{"cardia", &P::cardia, "m", "length of the cardia", 0.01, 0.1},
        F{"stomach", &P::stomach, "m", "length of the stomach along its middle", 0.1, 0.4},
        F{"pylorus", &P::pylorus, "m", "length of the pylorus", 0.01, 0.06},
        F{"bulb", &P::bulb, "m", "what is seen of the duodenum", 0.02, 0.1},
        F{"pharynx_radius", &P::pharynx_radius, "m", "radius of the pharynx", 6e-3, 0.04},
        F{"oesophagus_radius", &P::oesophagus_radius, "m", "radius of the oesophagus, insufflated",
          6e-3, 0.03},
        F{"cardia_radius", &P::cardia_radius, "m", "radius of the open cardia", 5e-3, 0.03},
        F{"stomach_radius", &P::stomach_radius, "m", "largest radius of the stomach, insufflated",
          0.015, 0.08},
        F{"pylorus_radius", &P::pylorus_radius, "m", "radius of the open pylorus", 5e-3, 0.02},
        F{"throat_turn", &P::throat_turn, "rad", "turn of the pharynx", 0, 2.5},
        F{"cardia_turn", &P::cardia_turn, "rad", "turn of the cardia to the patient's left", 0,
          1.5},
        F{"stomach_turn", &P::stomach_turn, "rad", "turn of the stomach to the right", 0, 3},
        F{"stiffness", &P::stiffness, "N/m", "of the wall below the instrument", 10, 1e4},
        F{"damping", &P::damping, "N s/m", "of the wall", 0, 100},
        F{"bag_stiffness", &P::bag_stiffness, "N/m", "of the stomach as a whole against its place",
          10, 1e5},
        F{"bag_damping", &P::bag_damping, "N s/m", "of the same", 0.1, 1e3},
        F{"peristalsis", &P::peristalsis, "1",
          "share of the radius that a wave of the oesophagus takes", 0, 0.5},
        F{"peristalsis_speed", &P::peristalsis_speed, "m/s", "of that wave", 1e-3, 0.2},
        F{"peristalsis_period", &P::peristalsis_period, "s", "from wave to wave", 1, 600},
        F{"antral_depth", &P::antral_depth, "1",
          "share of the radius that a wave of the antrum takes", 0, 0.5},
        F{"antral_speed", &P::antral_speed, "m/s", "of that wave", 1e-4, 0.1},
        F{"antral_period", &P::antral_period, "s", "from wave to wave", 1, 600},
        F{"breathing", &P::breathing, "m",
          "way of the diaphragm up and down, half of it, with all below it", 0, 0.05},
        F{"breathing_rate", &P::breathing_rate, "Hz", "breaths a second", 0, 2},
        F{"force_limit", &P::force_limit, "N", "largest force that is called safe", 0.1, 100},
        F{"perforation", &P::perforation, "N", "force that counts as a perforation", 0.1, 200},
    };
  }
};

}  // namespace ebac::gastroscope
