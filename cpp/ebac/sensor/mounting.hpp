#pragma once

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "ebac/core/check.hpp"
#include "ebac/model/kinematics.hpp"

namespace ebac::sensor {

/// Mounting of a sensor in the handle. `rotation`, row by row, turns values from the axes of the
/// sensor to those of the handle, which are those of the ports. `sign` is 1 if the sensor measures
/// the force of the hand on the handle, -1 if it measures the opposite.
struct Mounting {
  std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
  int sign = 1;

  Axes to_handle(const Axes& value) const EBAC_RT {
    Axes turned = Axes::Zero();
    for (std::size_t i = 0; i < 9; ++i) turned[row(i)] += sign * rotation[i] * value[column(i)];
    return turned;
  }
  /// The other way: a rotation's inverse is its transpose.
  Axes to_sensor(const Axes& at_handle) const EBAC_RT {
    Axes turned = Axes::Zero();
    for (std::size_t i = 0; i < 9; ++i) turned[column(i)] += sign * rotation[i] * at_handle[row(i)];
    return turned;
  }

 private:
  static Eigen::Index row(std::size_t i) EBAC_RT { return static_cast<Eigen::Index>(i / 3); }
  static Eigen::Index column(std::size_t i) EBAC_RT { return static_cast<Eigen::Index>(i % 3); }
};

/// Throws std::invalid_argument where `rotation` is none or `sign` is neither 1 nor -1.
inline void check_mounting(const Mounting& mounting) {
  constexpr double kTolerance = 1e-6;
  const auto& r = mounting.rotation;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) {
      double product = 0;
      for (std::size_t k = 0; k < 3; ++k) product += r[3 * i + k] * r[3 * j + k];
      const double wanted = i == j ? 1 : 0;
      if (std::abs(product - wanted) <= kTolerance) continue;
      throw std::invalid_argument(
          "Mounting.rotation: rows " + std::to_string(i) + " and " + std::to_string(j) +
          " have the product " + shortest(product) + ", must be " + shortest(wanted) +
          " within 1e-06: the rows of a rotation are unit vectors at right angles to each other");
    }
  }
  const double determinant = r[0] * (r[4] * r[8] - r[5] * r[7]) -
                             r[1] * (r[3] * r[8] - r[5] * r[6]) +
                             r[2] * (r[3] * r[7] - r[4] * r[6]);
  if (determinant < 0) {
    throw std::invalid_argument(
        "Mounting.rotation: its determinant is -1, a mirror; no sensor sits mirrored: exchange two "
        "rows or the signs of one, or give sign = -1 where the sensor shows the force on the hand");
  }
  if (mounting.sign != 1 && mounting.sign != -1) {
    throw std::invalid_argument("Mounting.sign = " + std::to_string(mounting.sign) +
                                ": must be 1 (force of the hand on the handle) or -1");
  }
}

}  // namespace ebac::sensor
