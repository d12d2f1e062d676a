#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ebac/core/fields.hpp"
#include "ebac/model/noise.hpp"

namespace ebac {

/// A force/torque sensor between handle and hand. Its lag belongs to the plant, which is
/// continuous; the rest happens when a reading is taken.
struct ForceSensor {
  double lag = 8e-4;   // s
  double noise = 0;    // N, standard deviation
  double quantum = 0;  // N, 0 for none
  double range = 145;  // N
  double bias = 0;     // N
  double period = 0;   // s, from record to record; 0 for one in every tick
  double delay = 0;    // s, unknown to the loop
  double stops_at = std::numeric_limits<double>::infinity();    // s
  double resumes_at = std::numeric_limits<double>::infinity();  // s
  bool repeats = false;      // the last record while it stops, as if it were new
  bool disconnects = false;  // while it stops, its status says so
  double scale = 1;          // 1, unknown to the loop
  bool fitted = true;        // false for a device without one

  double read(double force, Noise& random) const EBAC_RT {
    if (!fitted) return 0;
    force *= scale;
    if (bias != 0) force += bias;
    if (noise > 0) force += noise * random.normal();
    if (quantum > 0) force = quantum * std::round(force / quantum);
    return std::clamp(force, -range, range);
  }

  bool stopped(double t) const EBAC_RT { return t >= stops_at && t < resumes_at; }

  /// Whether it shows every tick the force of that tick.
  bool prompt() const EBAC_RT {
    return !fitted ||
           (period == 0 && delay == 0 && stops_at == std::numeric_limits<double>::infinity());
  }

  static constexpr auto fields() {
    using F = Field<ForceSensor>;
    return std::array{
        F{"lag", &ForceSensor::lag, "s", "time constant of its first-order lag", 0, 0.1},
        F{"noise", &ForceSensor::noise, "N", "standard deviation of its noise", 0, 100},
        F{"quantum", &ForceSensor::quantum, "N", "one step of its reading; 0 for none", 0, 100},
        F{"range", &ForceSensor::range, "N", "largest force it can show; it saturates", 1e-3, 1e5},
        F{"bias", &ForceSensor::bias, "N", "what it shows without a force", -1e3, 1e3},
        F{"period", &ForceSensor::period, "s",
          "time from record to record, of which the loop knows the age; 0 for one in every tick", 0,
          0.02},
        F{"delay", &ForceSensor::delay, "s",
          "time from a force to its record, of which the loop knows nothing", 0, 0.02},
        F{"stops_at", &ForceSensor::stops_at, "s", "when no new record comes; inf for never", 0},
        F{"resumes_at", &ForceSensor::resumes_at, "s", "when records come again; inf for never", 0},
        F{"repeats", &ForceSensor::repeats, "1",
          "whether it sends its last record over and over meanwhile, so that nothing looks old"},
        F{"disconnects", &ForceSensor::disconnects, "1",
          "whether its status says disconnected meanwhile; its reading is the last record"},
        F{"scale", &ForceSensor::scale, "1",
          "what it shows over what acts, of which the loop knows nothing", 0.1, 10},
        F{"fitted", &ForceSensor::fitted, "1",
          "whether the device has one; the force reads 0 without"},
    };
  }
};

}  // namespace ebac
