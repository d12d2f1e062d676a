#include "ebac/control/virtual_coupling.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
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
bool unconditionally_stable(double stiffness, double damping, const DeviceFacts& facts,
                            const Timing& timing) {
  constexpr int kPoints = 400;
  const std::complex<double> i(0, 1);
  for (int n = 1; n <= kPoints; ++n) {
    const double w = std::numbers::pi / timing.dt * n / kPoints;  // rad/s, to Nyquist
    const std::complex<double> step = 1.0 - std::exp(-i * w * timing.dt);
    const std::complex<double> hold =
        std::exp(-i * w * ((1 + timing.delay) * timing.dt)) / (1.0 + i * w * facts.current_lag);
    const double admittance = (1.0 / (damping + stiffness * timing.dt / step)).real();
    if (admittance < 0) return false;
    if (std::cos(std::arg(hold)) + 2 * facts.damping * admittance / std::abs(hold) < 1)
      return false;
  }
  return true;
}

/// The stiffest coupling of a given damping, by bisection on a logarithmic scale; 0 if there is
/// none.
double stiffest(double damping, const DeviceFacts& facts, const Timing& timing) {
  double low = 1e-3;
  double high = 1e7;
  if (!unconditionally_stable(low, damping, facts, timing)) return 0;
  for (int n = 0; n < 40; ++n) {
    const double middle = std::sqrt(low * high);
    (unconditionally_stable(middle, damping, facts, timing) ? low : high) = middle;
  }
  return low;
}

}  // namespace

VirtualCoupling::Params VirtualCoupling::Params::design(const DeviceFacts& facts, Timing timing) {
  Params best{.coupling_stiffness = 0,
              .coupling_damping = 0,
              .count = facts.count,
              .peak_force = facts.peak_force};
  constexpr int kSteps = 60;
  for (int n = 0; n <= kSteps; ++n) {
    const double damping =
        0.01 * std::pow(1e4, static_cast<double>(n) / kSteps);  // 0.01 to 100 N s/m
    const double stiffness = stiffest(damping, facts, timing);
    if (stiffness > best.coupling_stiffness) {
      best.coupling_stiffness = stiffness;
      best.coupling_damping = damping;
    }
  }
  return best;
}

}  // namespace ebac
