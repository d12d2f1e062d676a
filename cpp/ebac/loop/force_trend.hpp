#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Level and trend of the hand's force, by a second-order filter that follows a ramp without lag and takes away no more
/// than noise can be.
class ForceTrend {
 public:
  ForceTrend() EBAC_RT = default;
  /// A force [N] that has not changed.
  explicit ForceTrend(double force) EBAC_RT : level_(force) {}

  /// `noisier`: the noise of the sensor, as a multiple of a usual one.
  void set_tick(double dt, double noisier) EBAC_RT {
    dt_ = dt;
    const double kept = std::exp(-dt / (kCalm * std::sqrt(noisier)));
    calming_ = 1 - kept * kept;
    trending_ = (1 - kept) * (1 - kept) / dt;
  }

  /// Takes a reading and the noise of the sensor [N].
  void follow(double measured, double deviation) EBAC_RT {
    const double off = measured - level_ - trend_ * dt_;
    const double noise = kNoise * deviation;
    trend_ += trending_ * off;
    level_ = measured - std::clamp((1 - calming_) * off, -noise, noise);
  }

  /// Another force, of which nothing else is known.
  void begin(double force) EBAC_RT {
    level_ = force;
    trend_ = 0;
  }

  double level() const EBAC_RT { return level_; }  // N, without noise
  double trend() const EBAC_RT { return trend_; }  // N/s

 private:
  static constexpr double kCalm = 12e-3;  // s, over which it is smoothed
  static constexpr double kNoise = 1.5;   // standard deviations that smoothing takes away at most

  double level_ = 0;
  double trend_ = 0;
  double dt_ = 0;        // s
  double calming_ = 0;   // share taken per tick
  double trending_ = 0;  // 1/s
};

}  // namespace ebac
