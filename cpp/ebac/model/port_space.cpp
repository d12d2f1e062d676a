#include "ebac/model/port_space.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

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

}  // namespace ebac
