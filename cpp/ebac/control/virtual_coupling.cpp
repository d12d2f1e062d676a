#include "ebac/control/virtual_coupling.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace ebac {

namespace {

/// Llewellyn's condition for an impedance display (Adams and Hannaford 1999), at every frequency of
/// a grid: Re Z_d >= 0, Re 1/Z_c >= 0, cos(arg H) + 2 Re Z_d Re(1/Z_c)/|H| >= 1.
///
/// The virtual side samples positions, so its velocity is the mean over the interval that ended:
/// Z_c = B_c + K_c T/(1 - 1/z), and its force does work over the next one. From one to the other lie
/// a sample, the delay and the current loop: H = z^-(1 + d)/(1 + s lag). The device takes at least b
/// times the square of that mean, Re Z_d = b. Without delay and lag the condition is Colgate's,
/// b >= K_c T/2 + B_c.
class Llewellyn {
 public:
  Llewellyn(const DeviceFacts& facts, const Timing& timing)
      : damping_(facts.damping), dt_(timing.dt) {
    const std::complex<double> i(0, 1);
    for (int n = 1; n <= kPoints; ++n) {
      const double w = std::numbers::pi / dt_ * n / kPoints;  // rad/s, to Nyquist
      const std::complex<double> hold =
          std::exp(-i * w * ((1 + timing.delay) * dt_)) / (1.0 + i * w * facts.current_lag);
      points_[static_cast<std::size_t>(n - 1)] = {.step = 1.0 - std::exp(-i * w * dt_),
                                                  .cosine = std::cos(std::arg(hold)),
                                                  .gain = std::abs(hold)};
    }
  }

  bool holds(double stiffness, double damping) const {
    for (const Point& at : points_) {
      const double admittance = (1.0 / (damping + stiffness * dt_ / at.step)).real();
      if (admittance < 0) return false;
      if (at.cosine + 2 * damping_ * admittance / at.gain < 1) return false;
    }
    return true;
  }

 private:
  static constexpr int kPoints = 400;
  struct Point {
    std::complex<double> step;    // 1 - 1/z
    double cosine = 0, gain = 0;  // of H
  };

  double damping_, dt_;
  std::array<Point, kPoints> points_;
};

/// The stiffest coupling of a given damping, by bisection on a logarithmic scale; 0 if there is
/// none.
double stiffest(double damping, const Llewellyn& stable) {
  double low = 1e-3;
  double high = 1e7;
  if (!stable.holds(low, damping)) return 0;
  for (int n = 0; n < 40; ++n) {
    const double middle = std::sqrt(low * high);
    (stable.holds(middle, damping) ? low : high) = middle;
  }
  return low;
}

}  // namespace

VirtualCoupling::Params VirtualCoupling::Params::design(const DeviceFacts& facts, Timing timing) {
  Params best{.coupling_stiffness = 0,
              .coupling_damping = 0,
              .count = facts.count,
              .peak_force = facts.peak_force};
  const Llewellyn stable(facts, timing);
  constexpr int kSteps = 60;
  for (int n = 0; n <= kSteps; ++n) {
    const double damping =
        0.01 * std::pow(1e4, static_cast<double>(n) / kSteps);  // 0.01 to 100 N s/m
    const double stiffness = stiffest(damping, stable);
    if (stiffness > best.coupling_stiffness) {
      best.coupling_stiffness = stiffness;
      best.coupling_damping = damping;
    }
  }
  return best;
}

}  // namespace ebac
