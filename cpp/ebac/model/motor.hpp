#pragma once

#include <array>
#include <cmath>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac {

/// A brushed DC motor. Defaults: the paper's Maxon RE 30.
struct Motor {
  double torque_constant = 0.0538;  // N m/A
  double rated_torque = 0.053;      // N m
  double rated_current = 1.0;       // A
  double stall_current = 7.45;      // A
  double rotor_inertia = 3.4e-6;    // kg m^2
  double ripple = 0;                // share of the torque
  double cogging = 0;               // N m
  int waves = 26;                   // per turn, of ripple and cogging

  double current(double torque) const EBAC_RT { return torque / torque_constant; }
  double torque(double current) const EBAC_RT { return current * torque_constant; }

  bool uneven() const EBAC_RT { return ripple != 0 || cogging != 0; }
  /// Torque under `current` at the rotor's `angle` [rad], where it is uneven.
  double uneven_torque(double current, double angle) const EBAC_RT {
    const double wave = std::sin(waves * angle);
    return torque(current) * (1 + ripple * wave) + cogging * wave;
  }

  static constexpr auto fields() {
    using F = Field<Motor>;
    return std::array{
        F{"torque_constant", &Motor::torque_constant, "N m/A", "torque per current (paper, II.B)",
          1e-5, 100},
        F{"rated_torque", &Motor::rated_torque, "N m", "continuous torque (paper, II.B)", 1e-5,
          1e3},
        F{"rated_current", &Motor::rated_current, "A", "largest continuous current (paper, II.A)",
          1e-3, 1e3},
        F{"stall_current", &Motor::stall_current, "A", "stall current (paper, II.A)", 1e-3, 1e4},
        F{"rotor_inertia", &Motor::rotor_inertia, "kg m^2",
          "rotor inertia (indicative: RE 30 data sheet, from memory)", 0, 1},
        F{"ripple", &Motor::ripple, "1", "amplitude of the torque ripple, of the torque", 0, 0.5},
        F{"cogging", &Motor::cogging, "N m", "amplitude of the cogging torque, without current", 0,
          1e3},
        F{"waves", &Motor::waves, "1", "periods of ripple and cogging per turn of the rotor", 1,
          10000},
    };
  }
};

/// Eq. (1) in Copley's units: I = 0.001 T Tc / Ts, with T in thousandths of the continuous torque,
/// Tc in 1e-5 N m, Ts in 1e-5 N m/A; the answer in A.
constexpr double copley_current(double torque_permille, double continuous_torque_1e5,
                                double torque_constant_1e5) EBAC_RT {
  return 0.001 * torque_permille * continuous_torque_1e5 / torque_constant_1e5;
}

/// The drive in front of the motor: how fast, how far and how finely it sets a current.
struct Drive {
  double current_lag = 3e-4;  // s
  double peak_ratio = 4.0;    // peak torque over rated torque
  bool permille = false;      // torque in whole thousandths of rated, as CiA 402 object 0x6071
  double current_offset = 0;  // A
  double current_noise = 0;   // A

  double peak_current(const Motor& motor) const EBAC_RT {
    const double wanted = motor.current(peak_ratio * motor.rated_torque);
    return wanted < motor.stall_current ? wanted : motor.stall_current;
  }

  static constexpr auto fields() {
    using F = Field<Drive>;
    return std::array{
        F{"current_lag", &Drive::current_lag, "s", "time constant of the current loop", 0, 0.1},
        F{"peak_ratio", &Drive::peak_ratio, "1", "peak over rated torque (42.4 N over 10.6 N)",
          0.01, 10},
        F{"permille", &Drive::permille, "1",
          "torque quantised to whole thousandths of rated (CiA 402, 0x6071)", 0, 1},
        F{"current_offset", &Drive::current_offset, "A",
          "current that flows where none is asked for", -10, 10},
        F{"current_noise", &Drive::current_noise, "A",
          "standard deviation of the current's error, another one in every tick", 0, 10},
    };
  }
};

}  // namespace ebac
