#include "ebac/sim/perceived_ripple.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace ebac {

namespace {

/// y = b0 x + b1 x' + b2 x'' - a1 y' - a2 y''.
class Biquad {
 public:
  static Biquad high_pass(double corner, double rate, double first) {
    const double k = std::tan(std::numbers::pi * corner / rate);
    const double scale = 1 / (1 + std::numbers::sqrt2 * k + k * k);
    Biquad f(scale, -2 * scale, scale, 2 * (k * k - 1) * scale,
             (1 - std::numbers::sqrt2 * k + k * k) * scale);
    f.x1_ = f.x2_ = first;  // as after a long rest
    return f;
  }

  static Biquad low_pass(double corner, double damping, double rate) {
    const double w = 2 * std::numbers::pi * corner / rate;
    const double radius = std::exp(-damping * w);
    const double a1 = -2 * radius * std::cos(w * std::sqrt(1 - damping * damping));
    const double a2 = radius * radius;
    return {1 + a1 + a2, 0, 0, a1, a2};
  }

  double operator()(double x) {
    // The last result comes in last: the next row waits for one product and one sum.
    const double y = ((b0_ * x + b1_ * x1_) + (b2_ * x2_ - a2_ * y2_)) - a1_ * y1_;
    x2_ = x1_;
    x1_ = x;
    y2_ = y1_;
    y1_ = y;
    return y;
  }

 private:
  Biquad(double b0, double b1, double b2, double a1, double a2)
      : b0_(b0), b1_(b1), b2_(b2), a1_(a1), a2_(a2) {}

  double b0_, b1_, b2_, a1_, a2_;
  double x1_ = 0, x2_ = 0, y1_ = 0, y2_ = 0;
};

}  // namespace

PerceivedRipple perceived_ripple(std::span<const double> force, double rate, std::size_t from) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!(rate >= kFewestVibrating)) return {kNone, kNone};
  Biquad vibration = Biquad::high_pass(kVibrationFrom, rate, force.front());
  Biquad weight = Biquad::low_pass(std::min(kPerceivedBelow, 0.4 * rate), kPerceivedDamping, rate);
  const double share = -std::expm1(-1 / (kPerceivedOver * rate));
  double squares = 0;  // N^2
  double mean = 0;     // N^2
  double most = 0;     // N^2
  for (std::size_t i = 0; i < force.size(); ++i) {
    const double y = vibration(force[i]);
    const double perceived = weight(y);
    if (i < from) continue;
    squares += y * y;
    mean = (1 - share) * mean + share * perceived * perceived;
    most = std::max(most, mean);
  }
  const auto rows = static_cast<double>(force.size() - from);
  return {std::sqrt(squares / rows), std::sqrt(2 * most) / kDetected};
}

}  // namespace ebac
