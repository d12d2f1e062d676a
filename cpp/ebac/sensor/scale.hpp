#pragma once

#include <array>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac::sensor {

/// Units and range of the counts of a sensor.
struct FtScale {
  double counts_per_force = 1e6;   // 1/N
  double counts_per_torque = 1e6;  // 1/(N m)
  double force_range = 0;          // N, 0 for none
  double torque_range = 0;         // N m, 0 for none

  static constexpr auto fields() {
    using F = Field<FtScale>;
    return std::array{
        F{"counts_per_force", &FtScale::counts_per_force, "1/N", "counts of one newton", 1e-3,
          1e12},
        F{"counts_per_torque", &FtScale::counts_per_torque, "1/(N m)", "counts of one newton metre",
          1e-3, 1e12},
        F{"force_range", &FtScale::force_range, "N",
          "a force along one of its axes that large is saturated, whatever its status says; 0 to "
          "trust the status",
          0, 1e6},
        F{"torque_range", &FtScale::torque_range, "N m", "the same of a torque", 0, 1e6},
    };
  }
};

}  // namespace ebac::sensor
