#include "ebac/model/joint_dynamics.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ebac {

namespace {

/// Acceleration of the joints that may move; the others are held at rest.
template <class Held>
Axes accelerate(Jacobian mass, Axes torque, Held held) EBAC_RT {
  for (int i = 0; i < kMaxAxes; ++i) {
    if (!held(i)) continue;
    mass.row(i).setZero();
    mass.col(i).setZero();
    mass(i, i) = 1;
    torque[i] = 0;
  }
  return mass.inverse() * torque;
}

/// At the handle, where it weighs least.
double least_rotor_mass(const DeviceModel& device) {
  const double longest = stretch(device.kinematics);
  return std::min(device.reflected_mass() / (longest * longest),
                  device.reflected_mass(device.axes() - 1));
}

double sign(double value) EBAC_RT { return value == 0 ? 0.0 : std::copysign(1.0, value); }

}  // namespace

JointDynamics::JointDynamics(const DeviceModel& device, const Hand& hand)
    : kinematics_(device.kinematics),
      friction_(device.mechanics),
      cable_(device.mechanics),
      axes_(device.axes()),
      travel_(travel(device.kinematics)),
      handle_mass_(device.mechanics.handle_mass),
      rotor_mass_(least_rotor_mass(device)),
      damping_(device.mechanics.damping),
      gravity_(device.mechanics.gravity),
      carried_weight_(device.compensation.gravity_mass * device.mechanics.gravity),
      hand_mass_(hand.mass),
      hand_damping_(hand.damping),
      hand_stiffness_(hand.stiffness),
      compliant_(device.mechanics.compliant()),
      speed_(compliant_ ? kDrotor : kDq) {
  for (int i = 0; i < kMaxAxes; ++i) {
    const double square = travel_[i] * travel_[i];
    rotor_inertia_[i] = square * device.reflected_mass(i);
    joint_damping_[i] = square * damping_;
  }
  if (compliant_ && !(rotor_mass_ > 0)) {
    throw std::invalid_argument(
        "Motor.rotor_inertia = 0 kg m^2: must be positive behind a cable that gives; set "
        "Mechanics.cable_stiffness = 0 N/m for a rigid one");
  }
}

Motion JointDynamics::motion(const JointState& z, const Load& load,
                             const Contact& contact) const EBAC_RT {
  const Axes dq = z.col(kDq);
  const Axes speed = z.col(speed_);
  const Pose at = pose(kinematics_, z.col(kQ), dq);
  const auto unused = [&](int i) EBAC_RT { return i >= axes_; };
  const auto at_rest = [&](int i) EBAC_RT { return i >= axes_ || stuck(contact, i); };

  Motion m;
  m.x = at.x;
  m.v = at.j * dq;
  Axes pull = hand_stiffness_ * (load.target - m.x) - hand_damping_ * m.v - hand_mass_ * at.drift;
  if (load.hand != nullptr) pull = model_force(load, m) - hand_mass_ * at.drift;
  const Axes lever = at.j.transpose() * pull + handle_mass_ * (gravity_ * at.weight - at.coriolis);
  const Axes motor =
      load.torque + joint_damping_.cwiseProduct(speed) + sliding_torque(speed, contact.slide);
  Jacobian mass = hand_mass_ * at.j.transpose() * at.j;
  mass.diagonal() += handle_mass_ * at.inertia;

  m.rate.col(kQ) = dq;
  m.rate.col(kEnergy) = (motor - carried_weight_ * at.weight).cwiseProduct(speed);
  if (compliant_) {
    const Axes cable = cable_torque(z, contact.flank);
    m.rate.col(kDq) = accelerate(mass, lever - cable, unused);
    m.held = cable - motor;
    m.rate.col(kRotor) = speed;
    for (int i = 0; i < axes_; ++i) {
      m.rate(i, kDrotor) = at_rest(i) ? 0.0 : m.held[i] / rotor_inertia_[i];
    }
    m.rate.col(kEnergy) += cable_loss(z, contact.flank);
  } else {
    mass.diagonal() += rotor_inertia_;
    m.rate.col(kDq) = accelerate(mass, lever - motor, at_rest);
    m.held = lever - motor - mass * m.rate.col(kDq);
  }
  m.f_hand = pull - hand_mass_ * (at.j * m.rate.col(kDq));
  return m;
}

/// The force of the hand's model, and the rates of its states.
Axes JointDynamics::model_force(const Load& load, Motion& m) const EBAC_RT {
  Axes pull = Axes::Zero();
  for (int i = 0; i < axes_; ++i) {
    const HandMotion at{.t = load.t, .x = m.x[i], .v = m.v[i], .target = load.target[i]};
    const HandState state = load.inner->col(i);
    const HandForce& hand = (*load.hand)[i];
    pull[i] = hand.force(at, state);
    m.inner.col(i) = hand.rate(at, state);
  }
  return pull;
}

Axes JointDynamics::sliding_torque(const Axes& dq, const Axes& slide) const EBAC_RT {
  Axes torque = Axes::Zero();
  if (!friction_.present()) return torque;
  for (int i = 0; i < axes_; ++i)
    torque[i] = slide[i] * travel_[i] * friction_.sliding(travel_[i] * dq[i]);
  return torque;
}

Axes JointDynamics::cable_torque(const JointState& z, const Axes& flank) const EBAC_RT {
  Axes torque = Axes::Zero();
  for (int i = 0; i < axes_; ++i) {
    if (flank[i] != 0) torque[i] = travel_[i] * cable_.force(gap(z, i), gap_rate(z, i), flank[i]);
  }
  return torque;
}

Axes JointDynamics::cable_loss(const JointState& z, const Axes& flank) const EBAC_RT {
  Axes loss = Axes::Zero();
  for (int i = 0; i < axes_; ++i) {
    if (flank[i] != 0) loss[i] = cable_.damping * gap_rate(z, i) * gap_rate(z, i);
  }
  return loss;
}

double JointDynamics::margin(const JointState& z, const Motion& at,
                             const Contact& contact) const EBAC_RT {
  double least = 1;
  for (int i = 0; i < axes_; ++i) {
    if (stuck(contact, i)) {
      least = std::min(least, travel_[i] * friction_.breakaway - std::abs(at.held[i]));
    } else if (friction_.present()) {
      least = std::min(least, contact.slide[i] * z(i, speed_));
    }
    if (compliant_)
      least = std::min(least, cable_.margin(gap(z, i), gap_rate(z, i), contact.flank[i]));
  }
  return least;
}

Contact JointDynamics::settle(JointState& z, const Load& load, const Contact& before,
                              Motion& after) const EBAC_RT {
  Contact contact;
  for (int i = 0; i < axes_; ++i) {
    if (before.slide[i] * z(i, speed_) < 0) z(i, speed_) = 0;
    if (friction_.present()) contact.slide[i] = sign(z(i, speed_));
    if (compliant_) contact.flank[i] = cable_.flank(gap(z, i), gap_rate(z, i));
  }
  after = motion(z, load, contact);
  for (int pass = 0; pass < axes_; ++pass) {  // one joint may free another: the weakest goes first
    int weakest = 0;
    double excess = 0;
    for (int i = 0; i < axes_; ++i) {
      if (!stuck(contact, i)) continue;
      const double beyond = std::abs(after.held[i]) - travel_[i] * friction_.breakaway;
      if (beyond <= excess) continue;  // not so for NaN, which must not hide behind friction
      excess = beyond;
      weakest = i;
    }
    if (excess == 0) break;
    contact.slide[weakest] = sign(after.held[weakest]);
    after = motion(z, load, contact);
  }
  return contact;
}

Axes JointDynamics::mean_hand_force(const Motion& from, const Motion& to, const Axes& target,
                                    double h) const EBAC_RT {
  const Axes x = (from.x + to.x) / 2 + h / 12 * (from.v - to.v);
  return hand_stiffness_ * (target - x) -
         (hand_damping_ * (to.x - from.x) + hand_mass_ * (to.v - from.v)) / h;
}

double JointDynamics::fastest_rate() const {
  const double lever = handle_mass_ + hand_mass_;
  const double stiffness = hand_stiffness_ + handle_mass_ * std::abs(gravity_) / travel_[0];
  if (!compliant_) {
    return std::max((damping_ + hand_damping_) / mass(), std::sqrt(stiffness / mass()));
  }
  const double either = 1 / lever + 1 / rotor_mass_;
  return std::max(damping_ / rotor_mass_ + hand_damping_ / lever + cable_.damping * either,
                  std::sqrt(stiffness / lever + cable_.stiffness * either));
}

}  // namespace ebac
