#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Shows changes of a force that are small and fast with a stiffness of their own.
///
/// The estimate of the position moves by a share of a count with the noise of sensor and encoder. A
/// stiff world makes a force of it, which rings with a heavy hand that B_v damps little. With the
/// world's stiffness K, k_f for small fast changes, c = 1 - k_f/K up to 7/8, and d = F_e - (F_e behind two
/// lags), at most F_e,
///   F = F_e - s c d / (1 + (d / D)^2)^2,   D = max(1.8 N, 6 counts K).
/// F is F_e at rest, differs from it by 0.29 D at most and in a large motion by less and less, and ends
/// with F_e.
///
/// The lags are t/(1 - sqrt c) and t/(1 + sqrt c), t = 90 ms: against a hand that pushes steadily they
/// make a critically damped pair of time constant t, whatever K is. One lag that ends as soon would
/// take damping c m/t from a hand of mass m; the pair takes less the faster it rings. Far from its end
/// d is brought there up to 20 times faster.
///
/// A force that is softer to fast changes than to slow ones gives energy out when it varies slowly,
/// one that is stiffer takes energy in: s > 0 costs, s < 0 earns.
class DynamicStiffness {
 public:
  /// `fast` in N/m; 0 shows every change whole. `count` is that of the encoder [m].
  DynamicStiffness(double fast, double count) EBAC_RT : fast_(fast), small_(kSmallCounts* count) {}

  /// Follows the force of the world and `slope`, its stiffness where the device is [N/m].
  void follow(double force, double slope, double dt) EBAC_RT {
    if (force == 0) {
      unknown_ = false;
      slow_ = slower_ = 0;
      return;
    }
    if (unknown_) slow_ = slower_ = force;
    unknown_ = false;
    if (slope != slope_) set_slope(slope);
    approach(force, dt);
  }

  /// What is shown of that force, with `softer` the share s, -1 to 1.
  double shown(double force, double softer) const EBAC_RT {
    if (force == 0) return 0;
    const double most = std::abs(force);
    const double change = std::clamp(force - slower_, -most, most);
    const double small = change * per_small_;
    const double large = 1 + small * small;
    return force - softer * share_ * change / (large * large);
  }

  /// The force has changed by `change` [N] without a motion.
  void shift(double change) EBAC_RT {
    slow_ += change;
    slower_ += change;
  }
  /// The world has become `by` times as stiff without a motion.
  void scale(double by) EBAC_RT {
    slow_ *= by;
    slower_ *= by;
  }
  /// The next force may be of a contact that has lasted.
  void forget() EBAC_RT { unknown_ = true; }
  void retune(const DynamicStiffness& next) EBAC_RT {
    fast_ = next.fast_;
    slope_ = -1;
  }

 private:
  static constexpr double kSoftest = 7.0 / 8;  // 1: eight times softer
  static constexpr double kLag = 0.09;         // s
  static constexpr double kSmall = 1.8;        // N
  static constexpr double kSmallCounts = 6;  // counts, of which a stiff world makes more than that
  static constexpr double kNear = 1.0 / 3;   // of a small change: from here on twice as fast
  static constexpr double kFastest = 20.0;   // times

  /// Values that depend on the world's slope alone.
  void set_slope(double slope) EBAC_RT {
    slope_ = slope;
    share_ = fast_ > 0 && slope > fast_ ? std::min(1 - fast_ / slope, kSoftest) : 0.0;
    root_ = std::sqrt(share_);
    per_small_ = 1 / std::max(kSmall, small_ * slope);
  }

  /// By implicit steps of both lags.
  void approach(double force, double dt) EBAC_RT {
    const double off = (force - slower_) * per_small_ * (1 / kNear);
    const double passed = std::min(1 + off * off, kFastest) * dt;
    const double first = passed * (1 - root_), second = passed * (1 + root_);
    const double per_both = 1 / ((kLag + first) * (kLag + second));
    slow_ += (force - slow_) * (first * (kLag + second) * per_both);
    slower_ += (slow_ - slower_) * (second * (kLag + first) * per_both);
  }

  double fast_;           // N/m
  double small_;          // m
  double slow_ = 0;       // N, behind the first lag
  double slower_ = 0;     // N, behind both
  bool unknown_ = false;  // whether they are
  double slope_ = -1;     // N/m, argument of the last set_slope
  double share_ = 0;      // c
  double root_ = 0;       // of c
  double per_small_ = 0;  // 1/N, 1/D
};

}  // namespace ebac
