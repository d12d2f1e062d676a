#pragma once

#include <algorithm>
#include <array>
#include <cmath>

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

  double read(double force, Noise& random) const EBAC_RT {
    if (noise > 0) force += noise * random.normal();
    if (quantum > 0) force = quantum * std::round(force / quantum);
    return std::clamp(force, -range, range);
  }

  static constexpr auto fields() {
    using F = Field<ForceSensor>;
    return std::array{
        F{"lag", &ForceSensor::lag, "s", "time constant of its first-order lag", 0, 0.1},
        F{"noise", &ForceSensor::noise, "N", "standard deviation of its noise", 0, 100},
        F{"quantum", &ForceSensor::quantum, "N", "one step of its reading; 0 for none", 0, 100},
        F{"range", &ForceSensor::range, "N", "largest force it can show; it saturates", 1e-3, 1e5},
    };
  }
};

}  // namespace ebac
