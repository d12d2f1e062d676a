#pragma once

#include <algorithm>
#include <array>

#include "ebac/model/device.hpp"

namespace ebac {

/// Safety limits on every axis. `of` a device: the limits of its motor, drive and lever.
struct Limits {
  double continuous_current = 0.985;  // A
  double peak_current = 3.94;         // A
  double thermal_time = 16;           // s
  double slew = 8000;                 // A/s
  double speed = 1.5;                 // m/s
  double jump = 5e-3;                 // m
  double edge = 0.0474;               // m
  double edge_stiffness = 500;        // N/m
  double edge_damping = 2;            // N s/m
  double end = 0.0574;                // m
  double force_age = 0.02;            // s
  bool watch_force = true;
  bool watch_motion = true;
  double unexplained = 2;  // N
  int overruns = 10;       // samples
  double pause = 0.05;     // s
  double starved = 2;      // s

  /// The edge lies 5 mm before the stops of the first axis, or halfway to them where they are closer than
  /// 10 mm; the end lies as far behind them.
  static Limits of(const DeviceModel& device) EBAC_RT {
    constexpr double kZone = 5e-3;      // m
    constexpr double kLeast = 1e-3;     // m
    constexpr double kPeakTick = 1e-3;  // s, from one peak to none
    const double way = stops(device.kinematics)[0] * device.travel();
    const double zone = std::min(kZone, way / 2);
    Limits limits;
    limits.continuous_current = device.motor.current(device.motor.rated_torque);
    limits.peak_current = device.drive.peak_current(device.motor);
    limits.slew = 2 * limits.peak_current / kPeakTick;
    limits.edge = std::max(way - zone, kLeast);
    limits.end = limits.edge + 2 * zone;
    return limits;
  }

  static constexpr auto fields() {
    using F = Field<Limits>;
    return std::array{
        F{"continuous_current", &Limits::continuous_current, "A",
          "current the motor takes for ever", 1e-3, 1e3},
        F{"peak_current", &Limits::peak_current, "A", "largest current at any time", 1e-3, 1e3},
        F{"thermal_time", &Limits::thermal_time, "s",
          "time constant of the winding in the i2t model (indicative: RE 30 data sheet, from "
          "memory)",
          0.01, 1e4},
        F{"slew", &Limits::slew, "A/s", "fastest change of the current", 1, 1e9},
        F{"speed", &Limits::speed, "m/s",
          "faster, over 0.9 ms and by more than an encoder count, is a fault", 1e-3, 100},
        F{"jump", &Limits::jump, "m", "a longer way in one tick is an encoder's fault", 1e-6, 1},
        F{"edge", &Limits::edge, "m",
          "way from the middle at which a soft wall begins; on a slide less by the way that its "
          "stops are closer",
          1e-3, 10},
        F{"edge_stiffness", &Limits::edge_stiffness, "N/m", "stiffness of that wall", 0, 1e5},
        F{"edge_damping", &Limits::edge_damping, "N s/m", "damping of that wall", 0, 500},
        F{"end", &Limits::end, "m", "way from the middle that is a fault; on a slide as edge", 1e-3,
          10},
        F{"force_age", &Limits::force_age, "s", "an older force is a fault", 1e-4, 10},
        F{"watch_force", &Limits::watch_force, "1",
          "whether a force sensor that is stale, saturated or gone is a fault", 0, 1},
        F{"watch_motion", &Limits::watch_motion, "1",
          "whether an encoder, a force sensor and a motor that contradict each other are a fault; "
          "needs a force sensor",
          0, 1},
        F{"unexplained", &Limits::unexplained, "N",
          "force at the handle by which they may differ: friction the device model does not know, "
          "weight, bias of the sensor",
          0.01, 1e3},
        F{"overruns", &Limits::overruns, "samples",
          "ticks in a row that came a tick or more too late, which are a fault", 1, 100000},
        F{"pause", &Limits::pause, "s",
          "time lost by late ticks, at once or within a second, that is a fault; after a fifth of "
          "it at once the force comes in anew",
          1e-3, 1e4},
        F{"starved", &Limits::starved, "s",
          "time for which a law's energy account may withhold more than half of its force", 1e-3,
          1e6},
    };
  }
};

/// By how much the stops of each axis lie before those of the first [m]: so do its edge and its end.
inline Axes shorter_ways(const Kinematics& kinematics) EBAC_RT {
  const Axes ways = stops(kinematics).cwiseProduct(travel(kinematics));
  return Axes::Constant(ways[0]) - ways;
}

/// Throws std::invalid_argument where two limits contradict each other.
void check_limits(const Limits& limits);
/// The same where they leave an axis of a device no way.
void check_ways(const Limits& limits, const DeviceModel& device);

}  // namespace ebac
