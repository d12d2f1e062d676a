#pragma once

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Shows changes of a force that are small and fast with a stiffness of their own.
///
/// The estimate of the position moves by a share of a count with the noise of sensor and encoder. A
/// stiff world makes a force of it, which rings with a heavy hand that B_v damps little. With
/// d = F_e - (F_e behind a lag of 0.2 s), the world's stiffness K and k_f for small fast changes,
///   F = F_e - (1 - k_f/K) d / (1 + (d / 1.8 N)^2)^2.
/// F is F_e at rest, differs from it by 0.6 N at most and in a large motion by less and less; the
/// slope lies between k_f and 5/4 K. A force that grows by 10 N in a second is shown less than 0.5 N
/// too small, so that the account lacks little of what a slow press stores.
class DynamicStiffness {
 public:
  /// `fast` in N/m; 0 shows every change whole.
  explicit DynamicStiffness(double fast) EBAC_RT : fast_(fast) {}

  /// `slope` is the world's stiffness where the device is [N/m].
  double step(double force, double slope, double dt) EBAC_RT {
    if (force == 0) return slow_ = 0;
    slow_ += (force - slow_) * dt / (kLag + dt);
    if (fast_ == 0 || slope <= fast_) return force;
    const double change = force - slow_;
    const double small = change / kSmall;
    const double large = 1 + small * small;
    return force - (1 - fast_ / slope) * change / (large * large);
  }

  void retune(const DynamicStiffness& next) EBAC_RT { fast_ = next.fast_; }

 private:
  static constexpr double kLag = 0.2;    // s
  static constexpr double kSmall = 1.8;  // N

  double fast_;      // N/m
  double slow_ = 0;  // N
};

}  // namespace ebac
