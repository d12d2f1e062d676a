#include "ebac/model/port_space.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <variant>

#include "ebac/model/velocity_of_power.hpp"

namespace ebac {

PortSpace::PortSpace(const Kinematics& kinematics, const Axes& x) EBAC_RT
    : axes_(ebac::axes(kinematics)),
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

ContactForce PortSpace::felt(const ContactForce& contact) const EBAC_RT {
  ContactForce made{
      .shared = contact.shared, .depth = contact.depth, .stiffness = contact.stiffness};
  int rows = 0;
  for (int i = 0; i < kMaxAxes && rows < axes_; ++i) {
    Axes rest = reach_.transpose() * contact.frame.row(i).transpose();
    for (int k = 0; k < rows; ++k)
      rest -= made.frame.row(k).dot(rest) * made.frame.row(k).transpose();
    const double length = rest.norm();
    if (length >= kAcross) made.frame.row(rows++) = rest / length;
  }
  for (int i = rows; i < kMaxAxes; ++i) made.frame.row(i) = Axes::Unit(i);
  made.force = reach_.transpose() * contact.force;
  made.along = made.frame * made.force;
  made.turned = !made.frame.isIdentity(0);
  if (!contact.velocity.isZero(0)) made.velocity = felt_velocity(contact, made.force);
  return made;
}

/// On a slope a surface that rises is faster along the ports than in space.
Axes PortSpace::felt_velocity(const ContactForce& contact, const Axes& felt) const EBAC_RT {
  Jacobian square = reach_.transpose() * reach_;
  for (int i = axes_; i < kMaxAxes; ++i) square(i, i) = 1;
  const Axes nearest = square.inverse() * (reach_.transpose() * contact.velocity);
  return velocity_of_power(nearest, contact.force.dot(contact.velocity), felt,
                           contact.force.norm());
}

}  // namespace ebac
