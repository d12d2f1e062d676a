#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/core/realtime.hpp"

namespace ebac::can {

/// Limits of the torque of a drive.
struct StageLimits {
  double ampere = 0.001;  // A per permille of the continuous torque, eq. (1)
  int torque = 1000;      // permille, the lesser of 0x6072 and 0x6073
  double peak_time = 2;   // s, at that torque before i2t acts
  double slope = 1000;    // permille/s, of the profile torque mode
};

/// From target torque to motor current. The current loop is ideal. The i2t limit is a budget of
/// (peak^2 - rated^2) peak_time: current squared above rated squared draws on it, below rated fills
/// it up; once spent, the current is limited to rated until the budget is full again.
class PowerStage {
 public:
  void configure(const StageLimits& limits) EBAC_RT { limits_ = limits; }

  /// Sets the target, permille; a ramp starts from where the demand is.
  void aim(int target, bool ramp) EBAC_RT { aim(target, ramp ? limits_.slope : kAtOnce); }
  /// The same with a slope of its own [permille/s].
  void aim(int target, double slope) EBAC_RT {
    asked_ = target;
    target_ = std::clamp(target, -limits_.torque, limits_.torque);
    slope_ = slope;
    if (slope >= kAtOnce) demand_ = target_;
  }
  void off() EBAC_RT {
    asked_ = target_ = 0;
    demand_ = 0;
  }

  void elapse(double seconds) EBAC_RT {
    const double now = torque() / kRated;
    spent_ = std::max(0.0, spent_ + (now * now - 1) * seconds);
    const double peak = limits_.torque / kRated;
    const double budget = std::max(0.0, peak * peak - 1) * limits_.peak_time;
    if (spent_ > budget) holding_ = true;
    if (spent_ == 0) holding_ = false;
    const double step = slope_ * seconds;
    demand_ += std::clamp(target_ - demand_, -step, step);
  }

  int demand() const EBAC_RT { return static_cast<int>(std::lround(demand_)); }
  /// Torque in effect, permille of the continuous torque.
  int torque() const EBAC_RT {
    const int most = holding_ ? std::min(static_cast<int>(kRated), limits_.torque) : limits_.torque;
    return std::clamp(demand(), -most, most);
  }
  double current() const EBAC_RT { return limits_.ampere * torque(); }  // A
  bool reached() const EBAC_RT { return demand_ == target_; }
  bool limited() const EBAC_RT { return asked_ != target_ || torque() != demand(); }
  bool holding() const EBAC_RT { return holding_; }

  static constexpr double kAtOnce = 4294967295.0;  // permille/s

 private:
  static constexpr double kRated = 1000;  // permille

  StageLimits limits_;
  int asked_ = 0;           // permille
  int target_ = 0;          // permille
  double demand_ = 0;       // permille
  double slope_ = kAtOnce;  // permille/s
  double spent_ = 0;        // s, rated current squared is 1
  bool holding_ = false;
};

}  // namespace ebac::can
