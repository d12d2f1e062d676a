#pragma once

#include <array>

#include "ebac/control/beta.hpp"
#include "ebac/core/device_facts.hpp"
#include "ebac/core/timing.hpp"

namespace ebac {

/// Parameters of `Ebac`: facts about the device, and settings of the law.
struct EbacParams {
  double damping = 2.0;       // N s/m
  double mass = 0.25;         // kg
  double current_lag = 3e-4;  // s
  double count = 3.07e-5;     // m
  double peak_force = 42.4;   // N
  double resonance = 0;       // Hz
  double force_noise = 0.03;  // N
  double growth = 1.2;
  double decay = 0.8;
  double kp = 0.1;
  double kd = 0;                    // s
  double filter = 5e-3;             // s
  double fast_stiffness = 3e3;      // N/m
  double heaviest_hand = 1.5;       // kg
  double pull = 20;                 // N
  double pull_rate = 1e3;           // N/s
  double reserve = 0.010;           // J
  double observed_reserve = 0.002;  // J
  bool continuity = true;
  bool recovery = true;
  bool injection = true;
  bool guard = true;
  bool observer = true;

  static constexpr EbacParams design(const DeviceFacts& facts, Timing) {
    return {.damping = facts.damping,
            .mass = facts.mass,
            .current_lag = facts.current_lag,
            .count = facts.count,
            .peak_force = facts.peak_force,
            .resonance = facts.resonance,
            .force_noise = facts.force_noise};
  }
  static constexpr auto fields() {
    using F = Field<EbacParams>;
    return std::array{
        F{"damping", &EbacParams::damping, "N s/m",
          "lower bound of the device's physical damping, b", 0.01, 500},
        F{"mass", &EbacParams::mass, "kg",
          "device mass at the handle, M_h; right to a few per cent", 1e-3, 100},
        F{"current_lag", &EbacParams::current_lag, "s", "time constant of the drive's current loop",
          0, 0.1},
        F{"count", &EbacParams::count, "m", "one encoder count at the handle", 0, 0.01},
        F{"peak_force", &EbacParams::peak_force, "N", "largest command", 1e-3, 1e4},
        F{"resonance", &EbacParams::resonance, "Hz",
          "first resonance of the structure, which bounds the virtual damper; 0 where none is "
          "known",
          0, 1e4},
        F{"force_noise", &EbacParams::force_noise, "N",
          "with the observer, standard deviation of the force sensor's noise, which the account "
          "does not charge; less than 0.03 N counts as that",
          0, 10},
        F{"growth", &EbacParams::growth, "1",
          "largest beta, as a multiple of that of the last tick: c1 of eq. (10)", 1, 1.2},
        F{"decay", &EbacParams::decay, "1",
          "smallest beta, as a multiple of that of the last tick: c2 of eq. (10)", 0.8, 1},
        F{"kp", &EbacParams::kp, "1",
          "gain on the error of the measured force: K_p of eq. (2); it divides the device's "
          "damping by 1 + K_p",
          0, 0.5},
        F{"kd", &EbacParams::kd, "s",
          "gain on the rate of the error of the measured force: K_d of eq. (2)", 0, 0.01},
        F{"filter", &EbacParams::filter, "s", "low-pass on the derivative of the force error", 0,
          1},
        F{"fast_stiffness", &EbacParams::fast_stiffness, "N/m",
          "with the observer, stiffness for changes of the force by some tenths of a newton that "
          "are faster than 1 Hz; 0 shows them with the world's own",
          0, 1e6},
        F{"heaviest_hand", &EbacParams::heaviest_hand, "kg",
          "heaviest hand that recovery, and on soft walls the damper, are designed for", 0, 10},
        F{"pull", &EbacParams::pull, "N", "largest pull of a hand the guard counts with", 0, 1e3},
        F{"pull_rate", &EbacParams::pull_rate, "N/s",
          "with the observer, fastest growth of the pull beyond what the force sensor shows", 0,
          1e6},
        F{"reserve", &EbacParams::reserve, "J", "reserve of the account, e(0) of eq. (3)", 0, 1},
        F{"observed_reserve", &EbacParams::observed_reserve, "J",
          "the same with the observer, where less is needed", 0, 1},
        F{"continuity", &EbacParams::continuity, "1",
          "whether beta is held between its growth and its decay from tick to tick: ratio rows of "
          "eq. (10)",
          0, 1},
        F{"recovery", &EbacParams::recovery, "1", "relaxation towards F_e at dx = 0", 0, 1},
        F{"injection", &EbacParams::injection, "1", "virtual damping while in contact", 0, 1},
        F{"guard", &EbacParams::guard, "1", "hold the command to what the account covers", 0, 1},
        F{"observer", &EbacParams::observer, "1",
          "meet the world at the observer's estimate, where a run has one", 0, 1},
    };
  }
};

/// State of `Ebac`, recorded in a trace.
struct EbacState : BetaTrace {
  double f_d = 0;       // N
  double injected = 0;  // N
  double energy = 0;    // J
  double slope = 0;     // N/m
  double admitted = 1;
  double starved = 0;  // s
  bool clamped = false;

  static constexpr auto fields() {
    using F = Field<EbacState>;
    return std::array{
        F{"beta", &EbacState::beta, "N/m",
          "slope dF/dx taken, eq. (9); NaN where dx = 0, and with the observer"},
        beta_min_field<EbacState>(),
        beta_max_field<EbacState>(),
        F{"f_d", &EbacState::f_d, "N",
          "F_d of eq. (8), before damping and force loop; with the observer the world's force as "
          "shown"},
        F{"injected", &EbacState::injected, "N", "force of the virtual damper"},
        F{"energy", &EbacState::energy, "J", "account: what the virtual side may give back"},
        F{"slope", &EbacState::slope, "N/m", "stiffness of the environment as seen"},
        F{"admitted", &EbacState::admitted, "1", "share of the command the guard let through"},
        F{"starved", &EbacState::starved, "s",
          "time for which the guard has let less than half of the command through; falls tenfold "
          "when it lets more"},
        F{"clamped", &EbacState::clamped, "1",
          "1 where the energy bound or the guard held the force"},
    };
  }
};

}  // namespace ebac
