#pragma once

#include <Eigen/Core>
#include <cmath>

#include "ebac/identify/arm_record.hpp"

namespace ebac {

/// A sum of logarithms, of which few are taken: products are ten times faster.
class LogSum {
 public:
  void add(double value) EBAC_RT {
    product_ *= value;
    if (product_ > 1e-200 && product_ < 1e200) return;
    sum_ += std::log(product_);
    product_ = 1;
  }
  double sum() const { return sum_ + std::log(product_); }

 private:
  double product_ = 1, sum_ = 0;
};

/// Covariance of position, velocity and the drift of the force reading, predicted.
struct ArmSpread {
  static constexpr double kFreePosition = 1;  // m^2: no information on the position of a handle
  static constexpr double kFreeVelocity = 1e2;

  double p00 = kFreePosition, p01 = 0, p11 = kFreeVelocity;
  double p02 = 0, p12 = 0, p22 = 0;

  /// Takes a reading of x + forward v of some variance in.
  ArmGains::Row weigh(double variance, double forward, LogSum& log_sum) EBAC_RT {
    if (std::isinf(variance)) return {};
    const double c0 = p00 + forward * p01;
    const double c1 = p01 + forward * p11;
    const double c2 = p02 + forward * p12;
    const double s = c0 + forward * c1 + variance;
    const double certainty = 1 / s;
    const ArmGains::Row row{c0 * certainty, c1 * certainty, c2 * certainty, std::sqrt(certainty)};
    p00 -= c0 * row.x;
    p01 -= c0 * row.v;
    p11 -= c1 * row.v;
    p02 -= c0 * row.drift;
    p12 -= c1 * row.drift;
    p22 -= c2 * row.drift;
    log_sum.add(s);
    return row;
  }

  /// The drift moves on by a variance, after it has kicked position and velocity over the tick.
  void move(const Eigen::Matrix2d& f, const Eigen::Vector2d& kick, const Eigen::Vector3d& q,
            double drift) EBAC_RT {
    const double a = f(0, 0) * p00 + f(0, 1) * p01 + kick[0] * p02;
    const double b = f(0, 0) * p01 + f(0, 1) * p11 + kick[0] * p12;
    const double c = f(1, 0) * p00 + f(1, 1) * p01 + kick[1] * p02;
    const double d = f(1, 0) * p01 + f(1, 1) * p11 + kick[1] * p12;
    const double g = f(0, 0) * p02 + f(0, 1) * p12 + kick[0] * p22;
    const double h = f(1, 0) * p02 + f(1, 1) * p12 + kick[1] * p22;
    p00 = a * f(0, 0) + b * f(0, 1) + g * kick[0] + q[0];
    p01 = a * f(1, 0) + b * f(1, 1) + g * kick[1] + q[1];
    p11 = c * f(1, 0) + d * f(1, 1) + h * kick[1] + q[2];
    p02 = g;
    p12 = h;
    p22 += drift;
  }
};

}  // namespace ebac
