#pragma once

#include "ebac/model/cable.hpp"
#include "ebac/model/device.hpp"
#include "ebac/model/friction.hpp"
#include "ebac/model/hand.hpp"
#include "ebac/model/pose.hpp"

namespace ebac {

/// State, one row per joint. The rotor is given as joint angle; behind a rigid cable it is the
/// lever, and its columns stay zero. The energy is part of the state, so that it is as exact as the
/// motion.
using JointState = Eigen::Matrix<double, kMaxAxes, 5>;
enum JointColumn { kQ, kDq, kRotor, kDrotor, kEnergy };  // rad, rad/s, rad, rad/s, J

/// External inputs: motor torque behind the current loop [N m] and target position of the hand [m];
/// for a hand with a model also the model, the time and its own states.
struct Load {
  Axes torque;
  Axes target;
  const HandForces* hand = nullptr;
  double t = 0;  // s
  const HandStates* inner = nullptr;
};

/// The discrete half of the state. It is fixed inside a segment, where the motion is smooth.
struct Contact {
  Axes slide = Axes::Zero();  // direction of sliding, 0 while static friction holds
  Axes flank = Axes::Zero();  // side on which the cable pushes, 0 inside the play
};

/// Accelerations and forces from state, load and contact.
struct Motion {
  JointState rate = JointState::Zero();
  Axes held = Axes::Zero();               // N m, static friction of a stuck joint
  Axes x = Axes::Zero();                  // m
  Axes v = Axes::Zero();                  // m/s
  Axes f_hand = Axes::Zero();             // N, eq. (4) or the hand's model
  HandStates inner = HandStates::Zero();  // per s, of the model's own states
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

  /// Not negative while `contact` fits the state; its zero is the event. Only the sign has a
  /// meaning.
  double margin(const JointState& z, const Motion& at, const Contact& contact) const EBAC_RT;

  /// Stops joints that slid past zero, then finds the consistent contact; `after` is its motion.
  Contact settle(JointState& z, const Load& load, const Contact& before,
                 Motion& after) const EBAC_RT;

  /// Mean of f_hand over a step of `h`, from eq. (4) itself: no derivative of f_hand is needed.
  /// `target` is that of its middle.
  Axes mean_hand_force(const Motion& from, const Motion& to, const Axes& target,
                       double h) const EBAC_RT;

  /// Angle of the motor, as joint angle.
  double motor_joint(const JointState& z, int i) const EBAC_RT {
    return z(i, compliant_ ? kRotor : kQ);
  }

  /// Fastest rate of the smooth motion [1/s], estimated in the middle of the workspace.
  double fastest_rate() const;
  /// How fast Stribeck friction lets go [1/s].
  double stribeck_rate() const { return friction_.slope() / (compliant_ ? rotor_mass_ : mass()); }

 private:
  Axes model_force(const Load& load, Motion& m) const EBAC_RT;
  Axes sliding_torque(const Axes& dq, const Axes& slide) const EBAC_RT;
  Axes cable_torque(const JointState& z, const Axes& flank) const EBAC_RT;
  Axes cable_loss(const JointState& z, const Axes& flank) const EBAC_RT;
  bool stuck(const Contact& c, int i) const EBAC_RT {
    return friction_.present() && c.slide[i] == 0;
  }
  double gap(const JointState& z, int i) const EBAC_RT {
    return travel_[i] * (z(i, kQ) - z(i, kRotor));
  }
  double gap_rate(const JointState& z, int i) const EBAC_RT {
    return travel_[i] * (z(i, kDq) - z(i, kDrotor));
  }
  double mass() const { return handle_mass_ + hand_mass_ + rotor_mass_; }

  Kinematics kinematics_;
  Friction friction_;
  Cable cable_;
  int axes_;
  Axes travel_;            // m, way at the handle per joint angle
  double handle_mass_;     // kg
  double rotor_mass_;      // kg, felt at the handle; the least of all axes
  double damping_;         // N s/m
  double gravity_;         // m/s^2
  double carried_weight_;  // N, by the motor
  double hand_mass_;       // kg
  double hand_damping_;    // N s/m
  double hand_stiffness_;  // N/m
  Axes rotor_inertia_;     // kg m^2, at the joint
  Axes joint_damping_;     // N m s/rad
  bool compliant_;
  JointColumn speed_;  // of the motor
};

}  // namespace ebac
