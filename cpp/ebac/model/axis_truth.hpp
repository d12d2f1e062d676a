#pragma once

#include <array>

#include "ebac/core/fields.hpp"

namespace ebac {

/// True values of an axis, which only a simulation knows.
struct AxisTruth {
  double x = 0;         // m
  double v = 0;         // m/s
  double f_hand = 0;    // N
  double f_motor = 0;   // N
  double f_sensor = 0;  // N
  double energy = 0;    // J

  static constexpr auto fields() {
    using F = Field<AxisTruth>;
    return std::array{
        F{"x", &AxisTruth::x, "m", "true handle position"},
        F{"v", &AxisTruth::v, "m/s", "true handle velocity"},
        F{"f_hand", &AxisTruth::f_hand, "N", "force of the hand on the handle, towards +x"},
        F{"f_motor", &AxisTruth::f_motor, "N", "motor force behind the current loop; resists +x"},
        F{"f_sensor", &AxisTruth::f_sensor, "N", "hand force behind the sensor's lag"},
        F{"energy", &AxisTruth::energy, "J",
          "physical port energy: integral of (f_motor v + b v^2 + friction |v|) dt, without the "
          "work that carries "
          "the weight of the device"},
    };
  }
};

}  // namespace ebac
