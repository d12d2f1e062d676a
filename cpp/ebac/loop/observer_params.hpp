#pragma once

#include <algorithm>
#include <array>

#include "ebac/core/fields.hpp"
#include "ebac/core/observer_count.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/core/timing.hpp"
#include "ebac/model/device.hpp"

namespace ebac {

/// Facts the observer is designed from: those of the device and its force sensor, nothing of wall or
/// hand.
struct ObserverParams {
  double mass = 0.25;         // kg
  double damping = 2.0;       // N s/m
  double friction = 0.0;      // N
  double count = 3.07e-5;     // m
  double current_lag = 3e-4;  // s
  double force_lag = 8e-4;    // s
  double force_noise = 0.03;  // N
  double force_age = 3e-3;    // s
  int delay = 1;              // samples
  bool every_law = false;
  bool learn_scale = false;

  /// Of a device and the delay of its commands. It counts with 0.8 of the declared friction: with more than there is,
  /// the estimate rests while the device moves, and walls are lost; what is missing it learns as a disturbance. Of a fine
  /// encoder it reckons with a coarser count (`observer_count`).
  static ObserverParams of(const DeviceModel& device, const Timing& timing) EBAC_RT {
    return {.mass = device.mass(),
            .damping = device.mechanics.damping,
            .friction = 0.8 * device.mechanics.coulomb,
            .count = observer_count(device.facts().count, device.mass(), timing.dt),
            .current_lag = device.drive.current_lag,
            .force_lag = device.sensor.lag,
            .force_noise = device.facts().force_noise,
            .delay = timing.delay};
  }
  static constexpr double kLeastNoise = DeviceFacts{}.force_noise;  // N, of a usual six-axis sensor

  static constexpr auto fields() {
    using F = Field<ObserverParams>;
    return std::array{
        F{"mass", &ObserverParams::mass, "kg", "device mass at the handle, M_h", 1e-3, 100},
        F{"damping", &ObserverParams::damping, "N s/m", "viscous damping of the device, B_h", 0,
          500},
        F{"friction", &ObserverParams::friction, "N",
          "Coulomb friction of the device, no more than there is", 0, 100},
        F{"count", &ObserverParams::count, "m",
          "one encoder count at the handle, or of a finer encoder 1.1 N dt^2 / mass", 1e-9, 0.01},
        F{"current_lag", &ObserverParams::current_lag, "s",
          "time constant of the drive's current loop", 0, 0.1},
        F{"force_lag", &ObserverParams::force_lag, "s", "time constant of the force sensor", 0,
          0.1},
        F{"force_noise", &ObserverParams::force_noise, "N",
          "standard deviation of its noise; sets the bandwidth", 1e-4, 10},
        F{"force_age", &ObserverParams::force_age, "s",
          "an older force is not used: the estimate is faded out", 1e-5, 1},
        F{"delay", &ObserverParams::delay, "samples",
          "ticks from computing a command to its acting", 0, kMaxDelay},
        F{"every_law", &ObserverParams::every_law, "1",
          "laws that are not made for it meet the world at the estimate too", 0, 1},
        F{"learn_scale", &ObserverParams::learn_scale, "1",
          "learn from swings on a world how strong the motor is for the force sensor, to 10 %", 0,
          1},
    };
  }
};

}  // namespace ebac
