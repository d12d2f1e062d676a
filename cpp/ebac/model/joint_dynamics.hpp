#pragma once

#include "ebac/model/device.hpp"
#include "ebac/model/hand.hpp"
#include "ebac/model/pose.hpp"

namespace ebac {

/// What moves, one row per joint. The rotor is told as joint angle; without a compliant cable it is the lever
/// and its columns stay zero. Energy rides along, so that it is as exact as the motion.
using JointState = Eigen::Matrix<double, kMaxAxes, 5>;
enum JointColumn { kQ, kDq, kRotor, kDrotor, kEnergy };  // rad, rad/s, rad, rad/s, J

/// What pushes from outside: motor torque behind the current loop [N m] and where the hand wants to be [m].
struct Load {
  Axes torque;
  Axes target;
};

/// The discrete half of the state. It is fixed inside a segment, where the motion is smooth.
struct Contact {
  Axes slide = Axes::Zero();  // direction of sliding, 0 while static friction holds
  Axes flank = Axes::Zero();  // side on which the cable pulls, 0 inside the backlash
};

/// What follows from state, load and contact.
struct Motion {
  JointState rate;
  Axes held;    // N m, torque that static friction must hold where a joint is stuck
  Axes x;       // m
  Axes v;       // m/s
  Axes f_hand;  // N, eq. (4)
};

/// Equations of motion of one device with one hand on it:
///
///   (M_lever + J^T M0 J) q'' = J^T (K0 (X0 - x) - B0 v - M0 J' q') + weight - coriolis - cable
///   J_rotor p'' = cable - motor - b R^2 p' - friction
///
/// A rigid cable makes p = q and leaves the sum of the two.
class JointDynamics {
 public:
  JointDynamics(const DeviceModel& device, const Hand& hand);

  Motion motion(const JointState& z, const Load& load, const Contact& contact) const EBAC_RT;

  /// Not negative while `contact` fits the state; its zero is the event. Only the sign has a meaning.
  double margin(const JointState& z, const Motion& at, const Contact& contact) const EBAC_RT;

  /// Stops what slid past zero, then finds the contact that fits; `after` is its motion.
  Contact settle(JointState& z, const Load& load, const Contact& before, Motion& after) const EBAC_RT;

  /// Mean of f_hand over a step of `h`, from eq. (4) itself: no derivative of f_hand is needed. `target` is
  /// that of its middle.
  Axes mean_hand_force(const Motion& from, const Motion& to, const Axes& target, double h) const EBAC_RT;

  double motor_joint(const JointState& z, int i) const EBAC_RT { return z(i, angle_); }

  /// Fastest rate of the smooth motion [1/s], an upper bound near the middle of the workspace.
  double fastest_rate() const;
  /// Rate at which Stribeck friction falls [1/s]; it drives motion away and never makes a step unstable.
  double stribeck_rate() const;

 private:
  struct Cable {
    Axes torque;
    Axes loss;  // W
  };

  double friction(double speed) const EBAC_RT;  // N, while sliding
  Axes sliding_torque(const Axes& dq, const Axes& slide) const EBAC_RT;
  Cable cable(const JointState& z, const Axes& flank) const EBAC_RT;
  double push(const JointState& z, int i, double flank) const EBAC_RT;  // N m, of one flank
  double flank(const JointState& z, int i) const EBAC_RT;
  double flank_margin(const JointState& z, int i, double flank) const EBAC_RT;
  bool holds(const Contact& contact, int i) const EBAC_RT { return sticky_ && contact.slide[i] == 0; }

  Kinematics kinematics_;
  Mechanics mechanics_;
  double hand_mass_;
  double hand_damping_;
  double hand_stiffness_;
  int axes_;
  double radius_;
  double rotor_;           // kg m^2, at the joint
  double damping_;         // N m s/rad
  double static_torque_;   // N m
  double cable_stiffness_; // N m/rad
  double cable_damping_;   // N m s/rad
  double half_play_;       // rad
  bool sticky_;
  bool compliant_;
  JointColumn angle_;  // of the motor
  JointColumn speed_;
};

}  // namespace ebac
