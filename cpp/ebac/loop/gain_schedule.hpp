#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/core/realtime.hpp"
#include "ebac/loop/observer_gains.hpp"
#include "ebac/loop/observer_params.hpp"
#include "ebac/loop/sensor_noise.hpp"

namespace ebac {

/// By how much the encoder corrects the states of `AxisObserver`: its gains, scheduled by motion, by the noise of the
/// sensor and by how well the readings agree with the model.
///
/// The steady Kalman gain of force noise against a reading uniform within a count has the bandwidth
/// w = sqrt(sqrt(12) force_noise / (M count)). 0.4 of it is used in motion, 0.3 at rest, where an edge of a count would
/// be felt as a click; D is slower than x and u, by far so at rest. All of w is used where the force turns out to be
/// noisier than declared, and where the readings go on contradicting the model: friction that holds the device is a
/// force that D must learn, or x would rest at the end of its counts, with a velocity that is none.
///
/// A reading says little about where in its count the device is, so an innovation counts half up to one count and whole
/// beyond. Where the sensor shows less noise than declared, the half shrinks with it, down to a tenth, at rest: the
/// reading changes with the swing of a hand within a count, and would keep it going. In motion it does not: an error of
/// the model by a millinewton would take x through the whole count, and a hand that swings slowly would draw 0.4 mW.
class GainSchedule {
 public:
  explicit GainSchedule(const ObserverParams& params) EBAC_RT : count_(params.count),
                                                                force_noise_(params.force_noise) {}

  void restart() EBAC_RT {
    contradicted_ = 0;
    moving_ = 1;
  }

  /// Values that depend on `mass` [kg] and the time since the last tick alone.
  void set_tick(double mass, double dt) EBAC_RT;

  /// What an innovation `off` [m] adds to x [m], u [m/s] and D over the mass [m/s^2], at the velocity u [m/s].
  ObserverGains correct(double off, double u, const SensorNoise& noise) EBAC_RT {
    const double within = std::clamp(off, -count_, count_);
    const double noisy = std::clamp(2.5 * noise.rough() - 0.5, 0.0, 1.0);
    contradicted_ += ((std::abs(off) > 1.5 * count_ ? 1.0 : 0.0) - contradicted_) * forget_;
    moving_ = std::max(std::min(1.0, std::abs(u) * (1 / kMoving)), moving_ * resting_);
    double share = noise.deviation() * per_noise_;
    if (share < kQuiet)
      share = std::max(share, std::clamp(moving_ * (kMoving / kSlow), kLeast, 1.0));
    share *= within_;
    const double innovation = off - (1 - noisy) * (1 - share) * within;
    ObserverGains gain = at_rest_.towards(in_motion_, moving_);
    const double wrong = std::max(noisy, std::min(1.0, kLearn * (contradicted_ - kBears)));
    if (wrong > 0) gain = gain.towards(full_, wrong);
    return {gain.x * innovation, gain.v * innovation, gain.d * innovation};
  }

  /// Counts one more contradiction in this tick.
  void contradict() EBAC_RT { contradicted_ += (1 - contradicted_) * forget_; }

  /// Share of the last 50 ms in which the readings contradicted the model: more than 1.5 counts from where it put them.
  double contradicted() const EBAC_RT { return contradicted_; }

  /// 1 in motion, 0 at rest.
  double moving() const EBAC_RT { return moving_; }

 private:
  // Found by random search on 72 hands in 25 cells of delay, stiffness and error of the facts: force
  // ripple, hands at rest and energy given out.
  static constexpr double kDithered =
      0.09;                                // 1, (w dt)^2 from which noise moves x over whole counts
  static constexpr double kMoving = 0.01;  // m/s, from here on the device moves
  static constexpr double kSlow = 2.5e-3;  // m/s, from here on a quiet sensor counts as any other
  static constexpr double kQuiet = 0.5;    // of the declared noise: less is a quiet sensor
  static constexpr double kRests = 0.05;   // s, until it counts as resting
  static constexpr double kLeast = 0.2;    // of the share within a count, without noise
  static constexpr double kMemory = 0.05;  // s, of the contradictions
  static constexpr double kBears = 0.15;   // share of ticks that may contradict
  static constexpr double kLearn = 2;      // from here to 1/2 more, all gains rise to those of w

  double count_;        // m
  double force_noise_;  // N
  double contradicted_ = 0;
  double moving_ = 1;
  ObserverGains in_motion_{}, at_rest_{}, full_{};
  double within_ = 1;     // share of an innovation within a count
  double per_noise_ = 1;  // 1/N, of the declared noise
  double resting_ = 0;    // share kept per tick
  double forget_ = 0;     // share taken per tick
};

}  // namespace ebac
