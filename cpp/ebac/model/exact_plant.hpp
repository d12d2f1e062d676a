#pragma once

#include <vector>

#include "ebac/model/device.hpp"
#include "ebac/model/exact_axis.hpp"
#include "ebac/model/hand.hpp"

namespace ebac {

/// One straight axis of `device` with `hand` on it.
AxisParameters axis_parameters(const DeviceModel& device, const Hand& hand);

/// Independent rigid axes with a hand on each, integrated exactly. For `Linear` devices without
/// Stribeck friction, cable compliance and backlash and hands of eq. (4); SteppedPlant does the
/// rest.
class ExactPlant {
 public:
  /// Throws std::invalid_argument for another device or hand.
  ExactPlant(const DeviceModel& device, const Hand& hand, double tick);

  static bool covers(const DeviceModel& device);
  static bool covers(const DeviceModel& device, const Hand& hand) {
    return covers(device) && hand.linear();
  }

  /// Moves by `quanta` of 2^-20 tick from time `t` on, under the motor currents `current` [A].
  void advance(const Axes& current, double t, std::int64_t quanta) EBAC_RT {
    advance(current, t, quanta, axes_.size());
  }
  /// The same by who knows how many axes there are.
  void advance(const Axes& current, double t, std::int64_t quanta, std::size_t axes) EBAC_RT {
    if (quanta <= 0) return;
    if (!released_ && t >= hand_.release_at) let_go();
    const double time = tick_ * static_cast<double>(quanta) / static_cast<double>(kQuanta);
    for (std::size_t i = 0; i < axes; ++i) {
      const auto e = static_cast<int>(i);
      const Target target = hand_.target(e, t, time);
      axes_[i].advance(force_per_amp_ * current[e], target.x, target.rate, quanta);
    }
  }

  void aim(std::size_t axis, double target) EBAC_RT { hand_.aim(axis, target); }

  std::size_t axes() const EBAC_RT { return axes_.size(); }
  const AxisTruth& truth(std::size_t axis) const EBAC_RT { return axes_[axis].truth(); }
  double motor_angle(std::size_t axis) const EBAC_RT { return angle_per_metre_ * truth(axis).x; }

 private:
  void let_go() EBAC_RT;

  Hand hand_;
  double tick_;
  double force_per_amp_;
  double angle_per_metre_;
  std::vector<ExactAxis> axes_;
  std::vector<ExactAxis> without_hand_;
  bool released_ = false;
};

}  // namespace ebac
