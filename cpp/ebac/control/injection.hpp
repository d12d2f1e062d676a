#pragma once

#include <algorithm>

#include "ebac/core/realtime.hpp"
#include "ebac/core/sample.hpp"
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
    constexpr double kPhaseLag = 0.35;   // rad of delay at w, against 0.8 rad of lead
    constexpr double kCountForce = 1.0;  // N, largest force step one count may cause
    const double late = (timing.delay + 0.5) * timing.dt + current_lag;
    const double smooth = kCountForce * std::max(timing.dt, kVelocityTime) / (count * mass);
    bandwidth = std::min(kPhaseLag / late, smooth);
    stiffness = 0.9 * mass * bandwidth * bandwidth;
    damping = mass * bandwidth;
    velocity_lag = smoothing(timing);
  }

  /// Lag of the velocity of whole counts [s]: about 1 ms with the sample time.
  static double smoothing(const Timing& timing) EBAC_RT {
    return std::max(0.0, kVelocityTime - timing.dt);
  }

 private:
  static constexpr double kVelocityTime = 1e-3;  // s
};

/// The virtual damper of an injection: B_v on the velocity of whole counts, smoothed to about 1 ms.
///
/// It acts from the first count on. A dead band of one count makes the force calmer only where it is
/// noise; a contact then swings by two to three counts for ever.
class Damper {
 public:
  explicit Damper(const Injection& show) EBAC_RT : Damper(show.damping, show.velocity_lag) {}
  Damper(double damping, double velocity_lag) EBAC_RT : damping_(damping), lag_(velocity_lag) {}

  void set_tick(double dt) EBAC_RT {
    share_ = dt / (lag_ + dt);
    per_dt_ = 1 / dt;
  }

  /// Force on the velocity of the readings.
  double step(double dx) EBAC_RT {
    v_ += (dx * per_dt_ - v_) * share_;
    return damping_ * v_;
  }

  /// Force on the predicted velocity, as far as the observer is trusted.
  double step(const Port& port) EBAC_RT {
    const double read = step(port.dx);
    const double weight = port.est.weight;
    return weight > 0 ? read + weight * (damping_ * port.est.v_act - read) : read;
  }

  void retune(double damping) EBAC_RT { damping_ = damping; }
  void reset() EBAC_RT { v_ = 0; }

 private:
  double damping_;  // N s/m
  double lag_;      // s
  double share_ = 1;
  double per_dt_ = 0;  // 1/s
  double v_ = 0;       // m/s
};

}  // namespace ebac
