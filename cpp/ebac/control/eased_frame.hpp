#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ebac/core/realtime.hpp"
#include "ebac/model/contact_force.hpp"

namespace ebac {

/// Directions that share what pushes turn slowly while there is force: as they turn, the force along each changes, and a
/// law would take that for motion into the world or out of it.
///
/// A direction keeps its number while there is force, whichever surface it is normal to: accounts and commands in flight
/// are those of the number.
class EasedFrame {
 public:
  ContactForce ease(const ContactForce& contact, double dt) EBAC_RT {
    turned_ = Axes::Zero();
    if (!pushed_) return follow(contact);
    ContactForce eased = contact;
    eased.frame = towards(numbered_as_before(contact.frame), dt);
    eased.set_force(contact.force);
    eased.turned = true;
    turned_ = eased.frame * force_ - frame_ * force_;
    return follow(eased);
  }

  /// By how much the force of the last tick has changed along each direction because that has turned since [N].
  const Axes& turned() const EBAC_RT { return turned_; }

  /// Whether the direction in which `contact` pushes is another one than that of the last tick, as around a ball.
  bool turns(const ContactForce& contact) const EBAC_RT {
    return pushed_ && contact.frame != frame_;
  }

  /// The directions of a contact that shares none.
  const ContactForce& follow(const ContactForce& contact) EBAC_RT {
    frame_ = contact.frame;
    force_ = contact.force;
    pushed_ = !contact.force.isZero(0);
    return contact;
  }

 private:
  /// The same directions, forwards or backwards, each under the number of the one nearest to it.
  Jacobian numbered_as_before(const Jacobian& wanted) const EBAC_RT {
    Jacobian likeness = frame_ * wanted.transpose();  // of each number before to each wanted
    Jacobian made;
    for (int i = 0; i < kMaxAxes; ++i) {
      Eigen::Index before = 0, now = 0;
      likeness.cwiseAbs().maxCoeff(&before, &now);
      made.row(before) = std::copysign(1.0, likeness(before, now)) * wanted.row(now);
      likeness.row(before).setZero();
      likeness.col(now).setZero();
    }
    return made;
  }

  /// Some of the way from the directions of the last tick to others.
  Jacobian towards(const Jacobian& wanted, double dt) const EBAC_RT {
    const Jacobian turn = wanted.transpose() * frame_;
    const Eigen::AngleAxisd off(turn);
    const double most = (off.angle() / kLag + kSlowest) * dt;
    if (off.angle() <= most) return wanted;
    return frame_ * Eigen::AngleAxisd(-most, off.axis()).toRotationMatrix();
  }

  static constexpr double kLag = 0.01;     // s
  static constexpr double kSlowest = 0.1;  // rad/s, so that it arrives

  Jacobian frame_ = Jacobian::Identity();
  Axes force_ = Axes::Zero();   // N, of the last tick
  Axes turned_ = Axes::Zero();  // N
  bool pushed_ = false;         // in the last tick
};

}  // namespace ebac
