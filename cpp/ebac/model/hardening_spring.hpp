#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// The exponential spring force (exp(x / length) - 1) that goes on straight from a slope on; odd.
class HardeningSpring {
 public:
  HardeningSpring(double slope, double length, double steepest)
      : force_(slope * length),
        length_(length),
        steepest_(std::max(slope, steepest)),
        straight_from_(length * std::log(steepest_ / slope)) {}

  double force(double x) const EBAC_RT {
    const double bent = std::min(std::abs(x), straight_from_);
    const double beyond = std::abs(x) - bent;
    return std::copysign(force_ * std::expm1(bent / length_) + steepest_ * beyond, x);
  }
  double slope(double x) const EBAC_RT {
    return force_ / length_ * std::exp(std::min(std::abs(x), straight_from_) / length_);
  }
  double inverse(double force) const {
    const double f = std::abs(force);
    const double bent = std::min(f, force_ * std::expm1(straight_from_ / length_));
    return std::copysign(length_ * std::log1p(bent / force_) + (f - bent) / steepest_, force);
  }
  double steepest() const { return steepest_; }

 private:
  double force_;          // N
  double length_;         // m
  double steepest_;       // N/m
  double straight_from_;  // m
};

}  // namespace ebac
