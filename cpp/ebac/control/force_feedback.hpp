#pragma once

#include "ebac/core/realtime.hpp"

namespace ebac {

/// The PD part of eq. (2): K_p (F_D - F_M) + K_d d/dt(F_D - F_M). The raw difference of a noisy
/// force, as in the paper, is useless at 1 kHz, so the derivative is filtered.
///
/// Its cost: the handle feels M_h / (1 + K_p) and B_h / (1 + K_p).
class ForceFeedback {
 public:
  ForceFeedback(double kp, double kd, double filter) EBAC_RT : kp_(kp), kd_(kd), filter_(filter) {}

  double step(double desired, double measured, double dt) EBAC_RT {
    const double error = desired - measured;
    if (dt > 0) {
      if (kd_ != 0) rate_ += ((error - error_) / dt - rate_) * dt / (filter_ + dt);
      error_ = error;
    }
    return kp_ * error + kd_ * rate_;
  }
  void retune(double kp, double kd, double filter) EBAC_RT {
    if (kd_ == 0) rate_ = 0;  // none was followed until now
    kp_ = kp;
    kd_ = kd;
    filter_ = filter;
  }
  void reset() EBAC_RT { error_ = rate_ = 0; }

 private:
  double kp_;      // 1
  double kd_;      // s
  double filter_;  // s
  double error_ = 0;
  double rate_ = 0;
};

}  // namespace ebac
