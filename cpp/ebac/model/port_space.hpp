#pragma once

#include <cmath>
#include <variant>

#include "ebac/model/contact_force.hpp"
#include "ebac/model/kinematics.hpp"

namespace ebac {

/// The handle in space, seen from the ports of a device: what a world meets, and what of its force the ports feel.
///
/// A device of fewer than three axes cannot leave its line, plane or sphere: a force counts as far as it does work
/// there. The origin is the handle at rest in the middle.
class PortSpace {
 public:
  PortSpace(const Kinematics& kinematics, const Axes& x) EBAC_RT : axes_(ebac::axes(kinematics)),
                                                                   at_(x) {
    for (int i = 0; i < axes_; ++i) reach_(i, i) = 1;
    if (const auto* gimbal = std::get_if<Gimbal>(&kinematics)) {
      const double below = gimbal->radius * gimbal->radius - x[0] * x[0] - x[1] * x[1];
      const double height = std::sqrt(std::max(below, kFlattest * gimbal->radius * gimbal->radius));
      at_[2] = height - gimbal->radius;
      reach_(2, 0) = -x[0] / height;
      reach_(2, 1) = -x[1] / height;
    }
  }

  /// Of the handle [m].
  const Axes& at() const EBAC_RT { return at_; }
  /// Of the handle, from those of the ports [m/s].
  Axes velocity(const Axes& v) const EBAC_RT { return reach_ * v; }

  /// A contact in space as the ports feel it: force, directions and velocity of the surface in their coordinates.
  ContactForce felt(const ContactForce& contact) const EBAC_RT {
    ContactForce made{.force = reach_.transpose() * contact.force,
                      .depth = contact.depth,
                      .stiffness = contact.stiffness};
    int rows = 0;
    Axes speed = Axes::Zero();  // of the surface, along each row
    for (int i = 0; i < kMaxAxes && rows < axes_; ++i) {
      const Axes direction = contact.frame.row(i);
      Axes rest = reach_.transpose() * direction;
      for (int k = 0; k < rows; ++k)
        rest -= made.frame.row(k).dot(rest) * made.frame.row(k).transpose();
      const double length = rest.norm();
      if (length < kAcross) continue;
      made.frame.row(rows) = rest / length;
      speed[rows++] = direction.dot(contact.velocity) / length;
    }
    for (int i = rows; i < kMaxAxes; ++i) made.frame.row(i) = Axes::Unit(i);
    made.along = made.frame * made.force;
    made.velocity = made.frame.transpose() * speed;
    made.turned = !made.frame.isIdentity(0);
    return made;
  }

 private:
  static constexpr double kFlattest = 1e-4;  // of the radius squared: the lever never lies flat
  static constexpr double kAcross = 1e-3;    // a direction in which the ports cannot move

  int axes_;
  Axes at_;
  Jacobian reach_ = Jacobian::Zero();
};

}  // namespace ebac
