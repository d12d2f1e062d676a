#pragma once

#include <array>

#include "ebac/core/fields.hpp"

namespace ebac {

/// Facts about a device that a law may be designed from. Properties of the wall and the hand are
/// left out on purpose.
struct DeviceFacts {
  double damping = 2.0;       // N s/m
  double mass = 0.25;         // kg
  double count = 3.07e-5;     // m
  double current_lag = 3e-4;  // s
  double peak_force = 42.4;   // N
  double resonance = 0;       // Hz
  double force_noise = 0.03;  // N
  bool force_sensor = true;

  static constexpr auto fields() {
    using F = Field<DeviceFacts>;
    return std::array{
        F{"damping", &DeviceFacts::damping, "N s/m",
          "lower bound of the physical viscous damping at the handle, after compensation", -500,
          500},
        F{"mass", &DeviceFacts::mass, "kg", "mass felt at the handle; right to a few per cent",
          1e-3, 100},
        F{"count", &DeviceFacts::count, "m", "one encoder count at the handle", 0, 0.01},
        F{"current_lag", &DeviceFacts::current_lag, "s",
          "time constant of the drive's current loop", 0, 0.1},
        F{"peak_force", &DeviceFacts::peak_force, "N", "largest force the motor can give", 1e-3,
          1e4},
        F{"resonance", &DeviceFacts::resonance, "Hz",
          "first resonance of the structure, handle held; 0 where none is known", 0, 1e4},
        F{"force_noise", &DeviceFacts::force_noise, "N",
          "standard deviation of the force sensor's noise; less than 0.03 N counts as that", 0, 10},
        F{"force_sensor", &DeviceFacts::force_sensor, "1",
          "whether there is a force sensor; without one gains of a force loop are 0"},
    };
  }
};

}  // namespace ebac
