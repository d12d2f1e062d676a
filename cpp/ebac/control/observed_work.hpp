#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ebac/core/realtime.hpp"
#include "ebac/core/sample.hpp"

namespace ebac {

/// Energy that a force surely takes in over an interval, from the encoder and the observer.
///
/// A reading is known to half a count, so the sum of F dx over readings errs by at most half a count
/// times the total variation of F (summation by parts). Charging all of it is proven, and dissolves
/// a held wall within a minute: its force follows the noise of the sensor. So F is split in two:
///
///   F = F_r + n,  F_r = play of half-width max(0.3 N, 3/4 slope count) on F, zero without force
///
/// for a sensor of 0.03 N of noise; 0.3 N and the 0.05 N below grow with the noise that is declared.
///
/// F_r rests with the hand, n with the noise. n is counted with the observer's position, kept within
/// half a count of the reading, and charged half a count for what its change in a tick exceeds
/// 0.05 N: motion faster than the observer follows. For F_r the position is known where the reading
/// changes, at the edge of a count. Until the next edge it is reckoned from there with the observer's
/// displacement, and every change of F_r is charged the way to the further edge of the count: proven
/// for the sum of mean force times displacement, up to the present force times that way. At the next
/// edge the error of the reckoning shows. If that edge comes within 0.1 s, the changes since the last
/// one are charged this error instead.
///
/// Declared, not proven, is n, and that between two edges the reckoning is no worse than at the
/// second: both take mass, lags and sensor to be as given, and a motion below 20 Hz within one count
/// is not seen. Such a motion can draw at most 2 |n| count a cycle, again in every cycle;
/// docs/explanation/observer.md has what searches find.
class ObservedWork {
 public:
  /// `noise`: standard deviation of the force sensor's [N]. Without `edges` all of F is n.
  ObservedWork(double count, double noise, bool edges = true) EBAC_RT
      : half_(count / 2),
        play_(edges ? kPlay * noisier(noise) : std::numeric_limits<double>::infinity()),
        slow_(kSlow* noisier(noise)) {}

  /// How many times noisier than usual a force sensor is, at least 1; `noise` is its standard deviation [N].
  static double noisier(double noise) EBAC_RT { return std::max(1.0, noise / kUsual); }

  void retune(const ObservedWork& next) EBAC_RT { play_ = next.play_; }

  /// Counts from where the observer was at the last tick, within its count: the interval up to now is still to be taken.
  void start(const Port& port) EBAC_RT {
    const double last = port.x - port.dx;
    within_ = std::clamp(port.est.x - port.est.dx - last, -half_, half_);
    v_ = port.est.v;
    reached_ = last + within_;
    charged_ = changed_ = way_ = 0;  // its place is no edge
  }

  /// `mean` and `moment` are those of the force over the interval that ended with `port`, `slope` is that of the
  /// world [N/m], `b` the device's damping over the tick [N/m].
  double step(double mean, double moment, const Port& port, double slope, double b) EBAC_RT {
    const double play = std::max(play_, kCell * slope * 2 * half_);
    const bool no_force = port.f_applied == 0 && std::abs(mean) < kEnded;
    const double counted = no_force ? 0.0 : std::clamp(counted_, mean - play, mean + play);
    const double rest = mean - counted;
    const double place = within(port);
    const double fast = std::max(0.0, std::abs(rest - rest_) - slow_);
    const double moved = port.dx + place - within_;
    const double sure = std::max(std::abs(port.dx) - half_, 0.0);
    const double held = from_edge(counted, port);
    const double uneven = moment * (port.est.v - v_);
    v_ = port.est.v;
    counted_ = counted;
    rest_ = rest;
    within_ = place;
    return held + rest * moved + uneven - half_ * fast + b * sure * sure;
  }

 private:
  // The first two from a study before this law; kSlow from searches of `ebac worst` at d1K10. Both
  // forces are those of a sensor of usual noise.
  static constexpr double kUsual = 0.03;  // N, standard deviation
  static constexpr double kPlay = 0.3;    // N
  static constexpr double kCell = 0.75;   // counts by which the force of a held wall wanders
  static constexpr double kSlow = 0.05;   // N, a change in a tick that sensor noise can cause
  static constexpr double kEnded = 0.05;  // N
  static constexpr double kSoon = 0.1;    // s, from edge to edge

  double within(const Port& port) const EBAC_RT {
    return std::clamp(port.est.x - port.x, -half_, half_);
  }

  /// Work of F_r over the tick, charges included.
  double from_edge(double force, const Port& port) EBAC_RT {
    const double change = std::abs(force - counted_);
    const double before = reached_;
    const double reckoned = before + port.est.dx;
    unread_ += port.dt;
    changed_ += change;
    if (port.dx == 0) {
      reached_ = std::clamp(reckoned, port.x - half_, port.x + half_);
      const double unknown = (half_ + std::abs(reached_ - port.x)) * change;
      charged_ += unknown;
      return force * (reached_ - before) - unknown;
    }
    // Crossed in the middle of the tick, on average.
    const double beyond = std::min(half_, std::abs(port.est.v) * port.dt / 2);
    reached_ = port.x - std::copysign(half_ - beyond, port.dx);
    const double off = std::min(2 * half_, std::abs(reached_ - reckoned));
    const bool passed = port.dx * way_ > 0 && unread_ < kSoon;
    const double charge = passed ? charged_ - off * changed_ : -half_ * change;
    unread_ = charged_ = changed_ = 0;
    way_ = port.dx;
    return force * (reached_ - before) + charge;
  }

  double half_;         // m
  double play_;         // N
  double slow_;         // N
  double within_ = 0;   // m
  double v_ = 0;        // m/s
  double reached_ = 0;  // m, reckoned from the last edge
  double unread_ = 0;   // s, since that edge
  double way_ = 0;      // m, over that edge
  double charged_ = 0;  // J, since then
  double changed_ = 0;  // N, changes of F_r since then
  double counted_ = 0;  // N, F_r
  double rest_ = 0;     // N, n
};

}  // namespace ebac
