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

double sign(double value) EBAC_RT { return value == 0 ? 0.0 : std::copysign(1.0, value); }

}  // namespace

JointDynamics::JointDynamics(const DeviceModel& device, const Hand& hand)
    : kinematics_(device.kinematics),
      mechanics_(device.mechanics),
      hand_mass_(hand.mass),
      hand_damping_(hand.damping),
      hand_stiffness_(hand.stiffness),
      axes_(device.axes()),
      radius_(device.radius()),
      rotor_(device.motor.rotor_inertia * device.capstan.ratio() * device.capstan.ratio()),
      damping_(device.mechanics.damping * radius_ * radius_),
      static_torque_(std::max(device.mechanics.breakaway, device.mechanics.coulomb) * radius_),
      cable_stiffness_(device.mechanics.cable_stiffness * radius_ * radius_),
      cable_damping_(device.mechanics.cable_damping * radius_ * radius_),
      half_play_(device.mechanics.backlash / 2 / radius_),
      sticky_(static_torque_ > 0),
      compliant_(device.mechanics.compliant()),
      angle_(compliant_ ? kRotor : kQ),
      speed_(compliant_ ? kDrotor : kDq) {
  if (compliant_ && !(rotor_ > 0)) {
    throw std::invalid_argument(
        "Motor.rotor_inertia = 0 kg m^2: must be positive behind a cable that gives; set "
        "Mechanics.cable_stiffness = 0 for a rigid one");
  }
}

Motion JointDynamics::motion(const JointState& z, const Load& load, const Contact& contact) const EBAC_RT {
  const Axes dq = z.col(kDq);
  const Axes speed = z.col(speed_);
  const Pose at = pose(kinematics_, z.col(kQ), dq);
  const auto unused = [&](int i) EBAC_RT { return i >= axes_; };
  const auto stuck = [&](int i) EBAC_RT { return i >= axes_ || holds(contact, i); };

  Motion m;
  m.x = at.x;
  m.v = at.j * dq;
  const Axes pull = hand_stiffness_ * (load.target - m.x) - hand_damping_ * m.v - hand_mass_ * at.drift;
  const Axes slip = sliding_torque(speed, contact.slide);
  const Axes motor = -load.torque - damping_ * speed - slip;
  Axes lever = at.j.transpose() * pull +
               mechanics_.handle_mass * (mechanics_.gravity * at.weight - at.coriolis);
  Jacobian mass = hand_mass_ * at.j.transpose() * at.j;
  mass.diagonal() += mechanics_.handle_mass * at.inertia;

  Axes ddq;
  m.rate.setZero();
  m.rate.col(kQ) = dq;
  m.rate.col(kEnergy) = (load.torque + damping_ * speed + slip).cwiseProduct(speed);
  if (compliant_) {
    const Cable link = cable(z, contact.flank);
    ddq = accelerate(mass, lever - link.torque, unused);
    m.held = motor + link.torque;
    m.rate.col(kRotor) = speed;
    for (int i = 0; i < axes_; ++i) m.rate(i, kDrotor) = stuck(i) ? 0.0 : m.held[i] / rotor_;
    m.rate.col(kEnergy) += link.loss;
  } else {
    mass.diagonal().array() += rotor_;
    lever += motor;
    ddq = accelerate(mass, lever, stuck);
    m.held = lever - mass * ddq;
  }
  m.rate.col(kDq) = ddq;
  m.f_hand = pull - hand_mass_ * (at.j * ddq);
  return m;
}

Axes JointDynamics::mean_hand_force(const Motion& from, const Motion& to, const Axes& target,
                                    double h) const EBAC_RT {
  const Axes x = (from.x + to.x) / 2 + h / 12 * (from.v - to.v);
  return hand_stiffness_ * (target - x) -
         (hand_damping_ * (to.x - from.x) + hand_mass_ * (to.v - from.v)) / h;
}

double JointDynamics::friction(double speed) const EBAC_RT {
  if (!mechanics_.stribeck()) return mechanics_.coulomb;
  const double share = speed / mechanics_.stribeck_speed;
  return mechanics_.coulomb + (mechanics_.breakaway - mechanics_.coulomb) * std::exp(-share * share);
}

Axes JointDynamics::sliding_torque(const Axes& dq, const Axes& slide) const EBAC_RT {
  Axes torque = Axes::Zero();
  for (int i = 0; sticky_ && i < axes_; ++i) torque[i] = slide[i] * radius_ * friction(radius_ * dq[i]);
  return torque;
}

double JointDynamics::push(const JointState& z, int i, double flank) const EBAC_RT {
  return cable_stiffness_ * (z(i, kQ) - z(i, kRotor) - flank * half_play_) +
         cable_damping_ * (z(i, kDq) - z(i, kDrotor));
}

JointDynamics::Cable JointDynamics::cable(const JointState& z, const Axes& flank) const EBAC_RT {
  Cable link{Axes::Zero(), Axes::Zero()};
  for (int i = 0; i < axes_; ++i) {
    if (flank[i] == 0) continue;
    const double slip = z(i, kDq) - z(i, kDrotor);
    link.torque[i] = push(z, i, flank[i]);
    link.loss[i] = cable_damping_ * slip * slip;
  }
  return link;
}

/// A flank pushes and never pulls: the lever leaves it as soon as spring and damper together would pull.
/// Without backlash the cable is preloaded, and the two flanks are one.
double JointDynamics::flank(const JointState& z, int i) const EBAC_RT {
  if (half_play_ == 0) return 1;
  const double gap = z(i, kQ) - z(i, kRotor);
  const double side = sign(gap);
  return std::abs(gap) >= half_play_ && side * push(z, i, side) > 0 ? side : 0.0;
}

double JointDynamics::flank_margin(const JointState& z, int i, double flank) const EBAC_RT {
  if (flank != 0) return flank * push(z, i, flank);
  const double gap = z(i, kQ) - z(i, kRotor);
  const double side = sign(gap);
  return std::abs(gap) < half_play_ ? half_play_ - std::abs(gap) : -side * push(z, i, side);
}

double JointDynamics::margin(const JointState& z, const Motion& at,
                             const Contact& contact) const EBAC_RT {
  double least = 1;
  for (int i = 0; i < axes_; ++i) {
    if (sticky_) {
      least = std::min(least, contact.slide[i] == 0 ? static_torque_ - std::abs(at.held[i])
                                                    : contact.slide[i] * z(i, speed_));
    }
    if (compliant_ && half_play_ > 0) least = std::min(least, flank_margin(z, i, contact.flank[i]));
  }
  return least;
}

Contact JointDynamics::settle(JointState& z, const Load& load, const Contact& before,
                              Motion& after) const EBAC_RT {
  Contact contact;
  for (int i = 0; i < axes_; ++i) {
    if (sticky_ && before.slide[i] * z(i, speed_) < 0) z(i, speed_) = 0;
    contact.slide[i] = sticky_ ? sign(z(i, speed_)) : 0.0;
    contact.flank[i] = compliant_ ? flank(z, i) : 0.0;
  }
  after = motion(z, load, contact);
  for (int pass = 0; sticky_ && pass < axes_; ++pass) {  // at most one joint breaks away in each
    int weakest = 0;
    double excess = 0;
    for (int i = 0; i < axes_; ++i) {
      const double beyond = holds(contact, i) ? std::abs(after.held[i]) - static_torque_ : 0.0;
      if (beyond > excess) {
        excess = beyond;
        weakest = i;
      }
    }
    if (excess == 0) break;
    contact.slide[weakest] = sign(after.held[weakest]);
    after = motion(z, load, contact);
  }
  return contact;
}

double JointDynamics::fastest_rate() const {
  const double square = radius_ * radius_;
  const double handle = mechanics_.handle_mass * square;
  const double hand = hand_mass_ * square;
  const double lever = handle + hand + (compliant_ ? 0.0 : rotor_);
  double damping = hand_damping_ * square / lever;
  double stiffness = (hand_stiffness_ + mechanics_.handle_mass * std::abs(mechanics_.gravity) / radius_) *
                     square / lever;
  if (compliant_) {
    damping += damping_ / rotor_ + cable_damping_ * (1 / lever + 1 / rotor_);
    stiffness += cable_stiffness_ * (1 / lever + 1 / rotor_);
  } else {
    damping += damping_ / lever;
  }
  return std::max(damping, std::sqrt(stiffness));
}

double JointDynamics::stribeck_rate() const {
  if (!mechanics_.stribeck()) return 0;
  const double fall = (mechanics_.breakaway - mechanics_.coulomb) / mechanics_.stribeck_speed;
  const double rigid = mechanics_.handle_mass + hand_mass_ + rotor_ / (radius_ * radius_);
  return fall / (compliant_ ? rotor_ / (radius_ * radius_) : rigid);
}

}  // namespace ebac
