#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "ebac/core/sample.hpp"

namespace ebac {

/// Takes the step out of the force where one law follows another: the difference in the first tick fades out. The
/// energy accounts see it as any other force, in what acted.
class ForceBlend {
 public:
  static constexpr double kFade = 0.05;  // s

  /// From the next tick on. What is left of an earlier one is part of the force that acts, and so of the difference.
  void begin() EBAC_RT { share_ = kStart; }

  /// After the law's step, with the force of the tick before in `f_cmd` of the last one.
  template <std::size_t N>
  void step(std::span<Axis, N> axes) EBAC_RT {
    if (share_ > 0) fade(axes);
    for (std::size_t i = 0; i < axes.size(); ++i) before_[i] = axes[i].port.f_cmd;
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
