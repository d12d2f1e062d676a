#pragma once

#include <algorithm>

#include "ebac/core/realtime.hpp"
#include "ebac/core/timing.hpp"

namespace ebac {

/// How much stiffness and virtual damping a device can show, from its mass and its delay alone.
///
/// At w the delayed pair c + B_v s leads by about 0.8 rad, of which the delay may cost 0.35;
/// heavier hands lower the crossover. One encoder count of velocity may not cause more than 1 N.
struct Injection {
  double bandwidth;     // rad/s, w
  double stiffness;     // N/m, c_h = 0.9 M_h w^2
  double damping;       // N s/m, B_v = M_h w
  double velocity_lag;  // s

  Injection(double mass, double count, double current_lag, const Timing& timing) EBAC_RT {
    constexpr double kPhaseLag = 0.35;      // rad of delay at w, against 0.8 rad of lead
    constexpr double kCountForce = 1.0;     // N, largest force step one count may cause
    constexpr double kVelocityTime = 1e-3;  // s
    const double late = (timing.delay + 0.5) * timing.dt + current_lag;
    const double smooth = kCountForce * std::max(timing.dt, kVelocityTime) / (count * mass);
    bandwidth = std::min(kPhaseLag / late, smooth);
    stiffness = 0.9 * mass * bandwidth * bandwidth;
    damping = mass * bandwidth;
    velocity_lag = std::max(0.0, kVelocityTime - timing.dt);
  }
};

}  // namespace ebac
