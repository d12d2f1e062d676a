#pragma once

#include <array>
#include <cstdint>

#include "ebac/model/axis_truth.hpp"
#include "ebac/model/device.hpp"
#include "ebac/model/hand.hpp"
#include "ebac/model/joint_dynamics.hpp"
#include "ebac/model/linear_flow.hpp"

namespace ebac {

/// Any device and hand, integrated step by step: a gimbal, Stribeck friction, a cable that gives,
/// backlash, a hand with a model.
/// Where the exact plant applies too, each is the test of the other.
///
/// Runge and Kutta's classical method between events. An event (a joint stops, breaks away, a flank
/// of the backlash meets or leaves) ends its step; it is found by doing the step again, shorter.
/// The lags of current loop and sensor are followed in closed form, so only the mechanics bounds
/// the step.
class SteppedPlant {
 public:
  /// Throws std::invalid_argument when a time constant is too short for the tick or a hand's model
  /// does not fit it.
  SteppedPlant(const DeviceModel& device, const Hand& hand, double tick);

  /// Moves by `quanta` of 2^-20 tick from time `t` on, under the motor currents `current` [A].
  void advance(const Axes& current, double t, std::int64_t quanta) EBAC_RT;

  void aim(std::size_t axis, double target) EBAC_RT { hand_.aim(axis, target); }

  std::size_t axes() const EBAC_RT { return static_cast<std::size_t>(axes_); }
  const AxisTruth& truth(std::size_t axis) const EBAC_RT { return truth_[axis]; }
  double motor_angle(std::size_t axis) const EBAC_RT { return motor_angle_[axis]; }

 private:
  /// Inputs over one call of `advance`.
  struct Interval {
    Axes setpoint;  // N m, joint torque the current loop tends to
    Axes target;    // m, at its start
    Axes rate;      // m/s
    double t = 0;   // s, its start
  };
  struct Instant {
    double time = 0;  // s, since the interval began
    JointState state = JointState::Zero();
    Axes torque = Axes::Zero();  // N m
    Axes sensor = Axes::Zero();  // N
    Motion motion{};
    HandStates inner = HandStates::Zero();  // of the hand's model
  };

  Interval interval(const Axes& current, double t, double time) const EBAC_RT;
  Load load(double time, const Axes& torque, const HandStates& inner) const EBAC_RT;
  void hand_advanced() EBAC_RT;
  void settle() EBAC_RT;
  Instant step(const Instant& from, double h) const EBAC_RT;
  Axes sense(const Instant& from, const Axes& middle_force, const Instant& to,
             double h) const EBAC_RT;
  double margin(const Instant& at) const EBAC_RT;
  void move(double h, int& events) EBAC_RT;
  Instant event(Instant beyond, double h) const EBAC_RT;
  void report() EBAC_RT;

  HandForces forces_;  // none for eq. (4)
  HandBounds bounds_;
  JointDynamics dynamics_;
  JointDynamics without_hand_;
  Hand hand_;
  Kinematics kinematics_;
  double tick_;
  double step_;  // s, longest
  double torque_per_amp_;
  double ratio_;
  double current_lag_;
  double sensor_lag_;
  int axes_;
  bool held_;  // by a hand with a model
  Interval interval_{Axes::Zero(), Axes::Zero(), Axes::Zero()};
  Contact contact_{};
  Instant now_{};
  std::array<AxisTruth, kMaxAxes> truth_{};
  std::array<double, kMaxAxes> motor_angle_{};
};

}  // namespace ebac
