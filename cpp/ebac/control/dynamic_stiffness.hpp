#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Shows changes of a force that are small and fast with a stiffness of their own.
///
/// The estimate of the position moves by a share of a count with the noise of sensor and encoder. A
/// stiff world makes a force of it, which rings with a heavy hand that B_v damps little. With
/// d = F_e - (F_e behind a lag of 0.2 s), at most F_e, the world's stiffness K and k_f for small fast
/// changes,
///   F = F_e - s (1 - k_f/K) d / (1 + (d / 1.8 N)^2)^2.
/// F is F_e at rest, differs from it by 0.6 N at most and in a large motion by less and less, and ends
/// with F_e.
///
/// A force that is softer to fast changes than to slow ones gives energy out when it varies slowly,
/// one that is stiffer takes energy in. So s = 1 is for an account that can pay; with s < 0 it earns.
class DynamicStiffness {
 public:
  /// `fast` in N/m; 0 shows every change whole.
  explicit DynamicStiffness(double fast) EBAC_RT : fast_(fast) {}

  /// `slope` is the world's stiffness where the device is [N/m], `softer` the share s, -1 to 1.
  double step(double force, double slope, double softer, double dt) EBAC_RT {
    if (force == 0) {
      unknown_ = false;
      return slow_ = 0;
    }
    slow_ = unknown_ ? force : slow_ + (force - slow_) * dt / (kLag + dt);
    unknown_ = false;
    if (fast_ == 0 || slope <= fast_) return force;
    const double most = std::abs(force);
    const double change = std::clamp(force - slow_, -most, most);
    const double small = change / kSmall;
    const double large = 1 + small * small;
    return force - softer * (1 - fast_ / slope) * change / (large * large);
  }

  /// The next force may be of a contact that has lasted.
  void forget() EBAC_RT { unknown_ = true; }
  void retune(const DynamicStiffness& next) EBAC_RT { fast_ = next.fast_; }

 private:
  static constexpr double kLag = 0.2;    // s
  static constexpr double kSmall = 1.8;  // N

  double fast_;           // N/m
  double slow_ = 0;       // N
  bool unknown_ = false;  // whether slow_ is
};

}  // namespace ebac
