#pragma once

#include <array>
#include <cstdint>

#include "ebac/model/axis_truth.hpp"
#include "ebac/model/device.hpp"
#include "ebac/model/hand.hpp"

namespace ebac {

/// Any device, integrated step by step: a gimbal, Stribeck friction, a cable that gives, backlash. Where the
/// exact plant applies too, each is the test of the other.
class SteppedPlant {
 public:
  SteppedPlant(const DeviceModel& device, const Hand& hand, double tick);

  void advance(const Axes& current, double t, std::int64_t quanta) EBAC_RT;

  const AxisTruth& truth(std::size_t axis) const EBAC_RT { return truth_[axis]; }
  double motor_angle(std::size_t axis) const EBAC_RT { return motor_angle_[axis]; }

 private:
  std::array<AxisTruth, kMaxAxes> truth_{};
  std::array<double, kMaxAxes> motor_angle_{};
};

}  // namespace ebac
