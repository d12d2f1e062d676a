#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/core/realtime.hpp"
#include "ebac/core/sample.hpp"

namespace ebac {

/// Energy that a force surely takes in over an interval, from the encoder and the observer.
///
/// It is the work at the observer's position, kept within half a count of the reading. Where that
/// position is within half a count of the true one, the sum errs by at most half a count times the
/// total variation of the force (summation by parts). Charging all of it is proven, and dissolves a
/// held wall within a minute: its force follows the noise of the sensor. So half a count is charged
/// for what the force changes in a tick beyond 0.05 N: motion faster than the observer follows.
/// 0.05 N are for a sensor of 0.03 N of noise, and grow with the noise that is declared. Of a finer
/// encoder the charge takes the count that the observer reckons with (`observer_count`): what the
/// force does within a tick is unknown however fine the counts are. The device's damping takes in
/// what the smaller motion of reading and estimate gives: a reading that crosses an edge jumps by a count.
///
/// Declared, not proven, is the rest: that mass, lags and sensor are as given. A motion below 20 Hz
/// within one count is not seen, and can draw at most a count times the swing of the force a cycle,
/// again in every cycle; docs/explanation/observer.md has what searches find.
class ObservedWork {
 public:
  /// `count` is the encoder's and `reckoned` the observer's [m], `noise` the standard deviation of the
  /// force sensor's [N].
  ObservedWork(double count, double reckoned, double noise) EBAC_RT : within_count_(count / 2),
                                                                      half_(reckoned / 2),
                                                                      slow_(kSlow* noisier(noise)) {
  }

  /// How many times noisier than usual a force sensor is, at least 1; `noise` is its standard deviation [N].
  static double noisier(double noise) EBAC_RT { return std::max(1.0, noise / kUsual); }

  /// Counts from where the observer was at the last tick, within its count: the interval up to now is still to be taken.
  void start(const Port& port) EBAC_RT {
    within_ = limited(port.est.x - port.est.dx - (port.x - port.dx));
    v_ = port.est.v;
  }

  /// `mean` and `moment` are those of the force over the interval that ended with `port`, `b` is the
  /// device's damping over the tick [N/m].
  double step(double mean, double moment, const Port& port, double b) EBAC_RT {
    const double within = limited(port.est.x - port.x);
    const double moved = port.dx + within - within_;
    const double uneven = moment * (port.est.v - v_);
    const double fast = std::max(0.0, std::abs(mean - mean_) - slow_);
    const double sure = std::min(std::max(std::abs(port.dx) - half_, 0.0), std::abs(moved));
    within_ = within;
    v_ = port.est.v;
    mean_ = mean;
    return mean * moved + uneven - half_ * fast + b * sure * sure;
  }

 private:
  static constexpr double kUsual = 0.03;  // N, standard deviation
  static constexpr double kSlow = 0.05;   // N, a change in a tick that sensor noise can cause; from
                                          // searches of `ebac worst` at d1K10

  double limited(double within) const EBAC_RT {
    return std::clamp(within, -within_count_, within_count_);
  }

  double within_count_;  // m, half of a count of the encoder
  double half_;          // m, half of one of the observer
  double slow_;          // N
  double within_ = 0;    // m, of the observer from the reading
  double v_ = 0;         // m/s
  double mean_ = 0;      // N
};

}  // namespace ebac
