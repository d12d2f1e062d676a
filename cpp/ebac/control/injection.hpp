#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "ebac/core/realtime.hpp"
#include "ebac/core/sample.hpp"
#include "ebac/core/timing.hpp"

namespace ebac {

/// Mean of a signal and of what it was half a period of a resonance before, which cancels there.
class HalfPeriod {
 public:
  static constexpr int kMost = 64;  // ticks

  /// Half a period of `resonance` [Hz]; 0 where that is less than half a tick or longer than kept.
  static int ticks(double resonance, double dt) EBAC_RT {
    const double half = 0.5 / (resonance * dt);
    return half < kMost - 0.5 ? static_cast<int>(std::lround(half)) : 0;
  }

  explicit HalfPeriod(int ticks) EBAC_RT : ticks_(ticks) {}

  double step(double value) EBAC_RT {
    if (ticks_ == 0) return value;
    const auto at = static_cast<std::size_t>(next_);
    const double before = past_[at];
    past_[at] = value;
    next_ = next_ + 1 < ticks_ ? next_ + 1 : 0;
    return 0.5 * (value + before);
  }
  void reset() EBAC_RT { past_ = {}; }

 private:
  int ticks_;
  int next_ = 0;
  std::array<double, kMost> past_{};
};

/// How much stiffness and virtual damping a device can show, from its mass and its delay alone.
///
/// At w the delayed pair c + B_v s leads by about 0.8 rad, of which the delay may cost `phase_lag`;
/// heavier hands lower the crossover. One encoder count of velocity may not cause more than 1 N.
/// Where a first resonance of the structure is declared that the delay would drive, the velocity is
/// averaged with that of half its period before (`HalfPeriod`), and w follows from the later damper.
struct Injection {
  double bandwidth;     // rad/s, w
  double stiffness;     // N/m, c_h = 0.9 M_h w^2
  double damping;       // N s/m, B_v = M_h w
  double velocity_lag;  // s
  int half_period;      // ticks, of the resonance; 0 where nothing is averaged

  /// `resonance` in Hz, 0 where none is declared; `phase_lag` in rad.
  Injection(double mass, double count, double current_lag, const Timing& timing,
            double resonance = 0, double phase_lag = 0.35) EBAC_RT {
    constexpr double kCountForce = 1.0;  // N, largest force step one count may cause
    double late = (timing.delay + 0.5) * timing.dt + current_lag;
    const double smooth = kCountForce * std::max(timing.dt, kVelocityTime) / (count * mass);
    half_period = 0;
    if (quarter_turn(resonance, count, late, timing.dt)) {
      half_period = HalfPeriod::ticks(resonance, timing.dt);
      late += 0.5 * half_period * timing.dt;
    }
    bandwidth = std::min(phase_lag / late, smooth);
    stiffness = 0.9 * mass * bandwidth * bandwidth;
    damping = mass * bandwidth;
    velocity_lag = smoothing(timing);
  }

  /// Lag of the velocity of whole counts [s]: about 1 ms with the sample time.
  static double smoothing(const Timing& timing) EBAC_RT {
    return std::max(0.0, kVelocityTime - timing.dt);
  }

  static constexpr double kNoCount = 1e-12;  // m: of a velocity that is not read from counts

 private:
  static constexpr double kVelocityTime = 1e-3;  // s
  static constexpr double kFree = 1.5;  // of a resonance with the handle fixed: with it free

  /// Whether the delay turns a damper at the resonance by a quarter and more, so that it drives it. A
  /// velocity of readings is half a tick late; that of the observer is predicted.
  static bool quarter_turn(double resonance, double count, double late, double dt) EBAC_RT {
    return resonance * (count > kNoCount ? kFree * (late + 0.5 * dt) : late) > 0.25;
  }
};

/// The virtual damper of an injection: B_v on the velocity of whole counts, smoothed to about 1 ms.
///
/// It acts from the first count on. A dead band of one count makes the force calmer only where it is
/// noise; a contact then swings by two to three counts for ever.
class Damper {
 public:
  explicit Damper(const Injection& show) EBAC_RT
      : Damper(show.damping, show.velocity_lag, show.half_period) {}
  Damper(double damping, double velocity_lag, int half_period = 0) EBAC_RT
      : damping_(damping),
        lag_(velocity_lag),
        half_period_(half_period) {}

  void set_tick(double dt) EBAC_RT {
    share_ = dt / (lag_ + dt);
    per_dt_ = 1 / dt;
  }

  /// Force on the velocity of the readings.
  double step(double dx) EBAC_RT {
    v_ += (dx * per_dt_ - v_) * share_;
    return damping_ * half_period_.step(v_);
  }

  /// Force on the predicted velocity, as far as the observer is trusted.
  double step(const Port& port) EBAC_RT {
    const double read = step(port.dx);
    const double weight = port.est.weight;
    return weight > 0 ? read + weight * (damping_ * port.est.v_act - read) : read;
  }

  void retune(double damping) EBAC_RT { damping_ = damping; }
  void reset() EBAC_RT {
    v_ = 0;
    half_period_.reset();
  }

 private:
  double damping_;  // N s/m
  double lag_;      // s
  HalfPeriod half_period_;
  double share_ = 1;
  double per_dt_ = 0;  // 1/s
  double v_ = 0;       // m/s
};

}  // namespace ebac
