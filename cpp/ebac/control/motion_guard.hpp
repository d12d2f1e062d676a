#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/control/commands_in_flight.hpp"
#include "ebac/control/lagged_force.hpp"
#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac {

/// Largest command the ledger can pay for, for any environment and any hand that pulls
/// with no more than a declared force.
///
/// A mass cannot jerk: the displacement s of an interval lies within u of v T, and u grows by a T^2
/// with every interval, a = (pull + |F|) / M_h. A force F held over it gives out at most
///   R(F, u) = max over s of (-F s - B s^2), at least 0,
/// which is F^2/(4B) where s = -F/(2B) is within reach and its tangent line beyond. A command is
/// admitted when the ledger covers R of every force in flight, of its own, of what the current loop
/// still gives out when the commands have gone, and one count of the largest. Where the surface of
/// the virtual world yields by w in an interval, it takes |F| w in addition, which belongs into R:
/// a hand that follows faster puts in more.
class MotionGuard {
 public:
  /// `first` is the share of a jump that the first interval can deviate by: 1, or a half where the
  /// velocity is known at its start.
  MotionGuard(double damping, double mass, double count, double longest, double first = 1) EBAC_RT
      : b_(damping / longest),
        count_(count),
        tick_(longest),
        first_(first),
        jump_per_newton_(longest* longest / mass) {}

  /// Enough for any velocity with |v| T <= `step`: a cheap test before the exact one needs the
  /// velocity. It takes R <= |F| (|s| + |w|); `surface` is the velocity of the world's [m/s].
  bool surely_admits(double force, const CommandsInFlight& in_flight, const LaggedForce& lagged,
                     double energy, double step, double pull, double surface) const EBAC_RT {
    if (force == 0) return true;
    const double largest = std::max(in_flight.largest_with(force), std::abs(lagged.force()));
    const double last = step + std::abs(surface) * tick_ +
                        (1 + in_flight.size()) * (pull + largest) * jump_per_newton_;
    // Every interval, and the tails of two forces, at the largest force and the furthest reach.
    const double intervals = 1 + in_flight.size() + lagged.ticks() * (2 + lagged.later());
    return largest * (intervals * last + count_) <= energy;
  }

  /// The largest |F| <= |force| with the sign of `force` that `energy` covers, at velocity `v`,
  /// against a hand that pulls with `pull` and a world whose surface moves with `surface` [m/s].
  ///
  /// R is convex and R(0) = 0: the mean of a force that follows its command with a lag costs no more
  /// than its two parts.
  double admit(double force, const CommandsInFlight& in_flight, LaggedForce lagged, double energy,
               double v, double pull, double surface) const EBAC_RT {
    const double largest = std::max(in_flight.largest_with(0), std::abs(lagged.force()));
    const double jump = (pull + std::max(std::abs(force), largest)) * jump_per_newton_;
    const auto loss = [&](double held, int j) EBAC_RT {
      return Loss(held, v * tick_, (first_ + j) * jump, b_, surface * tick_).at(std::abs(held));
    };
    double left = energy;
    for (int j = 0; j < in_flight.size(); ++j) left -= loss(lagged.hold(in_flight[j]), j);
    const int d = in_flight.size();
    const double tail = lagged.force();  // when the new command begins to act
    left -= lagged.ticks() * (loss(tail, d) + std::abs(tail) * jump * lagged.later());
    const Loss own(force, v * tick_, (first_ + d) * jump, b_, surface * tick_);
    const double line = lagged.ticks() * jump;  // its own tail acts one jump further
    const double above = own.largest_force(left, line + count_);  // when it is itself the largest
    const double most = above >= largest
                            ? above
                            : std::min(largest, own.largest_force(left - count_ * largest, line));
    return std::copysign(std::min(std::abs(force), most), force);
  }

 private:
  /// R as a function of the size of the force, its sign taken out: zero, a tangent, a parabola, a
  /// tangent.
  class Loss {
   public:
    Loss(double force, double step, double reach, double b, double surface) EBAC_RT
        : b_(b),
          near_(std::copysign(step, step* force) + reach),
          far_(reach - std::copysign(step, step* force)),
          yields_(std::max(0.0, std::copysign(surface, surface* force))) {
      // s runs from -far_ to near_, measured along the force
    }

    double at(double force) const EBAC_RT {
      const double away = std::min(far_, std::max(force / (2 * b_), -near_));
      return std::max(0.0, (force - b_ * away) * away + force * yields_);
    }

    /// The largest force with at(force) + count * force <= energy; the cases are those of `at`.
    double largest_force(double energy, double count) const EBAC_RT {
      if (!(energy > 0)) return 0;
      const double way = count + yields_;
      if (far_ <= 0) {
        const double still = count > 0 ? energy / count : kAnyHigh;
        if (far_ + yields_ <= 0) return still;  // no motion can take anything out
        return std::min(still, (energy + b_ * far_ * far_) / (far_ + way));
      }
      if (near_ < 0) {
        const double most = (energy + b_ * near_ * near_) / (way - near_);
        // Of a small force the device damps more than it gives out, which pays for no count.
        if (most <= -2 * b_ * near_) return count > 0 ? std::min(most, energy / count) : most;
      }
      const double most = 2 * b_ * (std::sqrt(way * way + energy / b_) - way);
      if (most <= 2 * b_ * far_) return most;
      return (energy + b_ * far_ * far_) / (far_ + way);
    }

   private:
    double b_;
    double near_;    // furthest the interval can move with the force's direction of resistance
    double far_;     // furthest it can move against it, which gives energy out
    double yields_;  // way of the surface that yields to it
  };

  double b_;                // N/m, B = b/T
  double count_;            // m
  double tick_;             // s, the longest
  double first_;            // jumps, of the first interval
  double jump_per_newton_;  // m/N, T^2 / M_h
};

}  // namespace ebac
