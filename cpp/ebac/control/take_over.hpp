#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "ebac/core/sample.hpp"

namespace ebac {

/// Takes the step out of the force where one law or world follows another: the difference in the first tick fades out.
/// The energy account of a law sees it as any other force, in what acted, and begins anew when it has faded out.
class ForceBlend {
 public:
  static constexpr double kFade = 0.05;  // s

  /// From the next tick on. What is left of an earlier one is part of the force that acts, and so of the difference.
  void begin() EBAC_RT { share_ = kStart; }

  /// After the law's step, with the force of the tick before in `f_cmd` of the last one. Returns whether it ended now.
  template <std::size_t N>
  bool step(std::span<Axis, N> axes) EBAC_RT {
    const bool fading = share_ > 0;
    if (fading) fade(axes);
    for (std::size_t i = 0; i < axes.size(); ++i) before_[i] = axes[i].port.f_cmd;
    return fading && share_ == 0;
  }

 private:
  static constexpr double kStart = 2;  // above 1: the difference is not known yet

  void fade(std::span<Axis> axes) EBAC_RT {
    const bool first = share_ == kStart;
    share_ = first ? 1.0 : std::max(0.0, share_ - axes[0].port.dt / kFade);
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (first) difference_[i] = before_[i] - axes[i].port.f_cmd;
      axes[i].port.f_cmd += share_ * difference_[i];
    }
  }

  double share_ = 0;
  std::array<double, kMaxAxes> difference_{};  // N
  std::array<double, kMaxAxes> before_{};      // N
};

}  // namespace ebac
