#include "ebac/model/environment.hpp"

#include <cmath>
#include <numbers>

namespace ebac {

ContactForce Wall::turned(const Axes& x, const Axes& v) const EBAC_RT {
  const Axes n = normal();
  return ContactForce::along_normal(n, push_along(n.dot(x), n.dot(v)));
}

ContactForce Wall::moving(const Axes& x, const Axes& v, double t) const EBAC_RT {
  const Axes n = normal();
  const double w = 2 * std::numbers::pi * motion_frequency;
  const Axes rate = w * motion_amplitude * std::cos(w * t) * n;
  ContactForce made = contact(x - motion_amplitude * std::sin(w * t) * n, v - rate);
  made.velocity = rate;
  return made;
}

ContactForce Corner::contact(const Axes& x, const Axes& v) const EBAC_RT {
  const Axes n = first.normal();
  const Axes m = second.normal();
  const double one = first.push_along(n.dot(x), n.dot(v));
  const double other = second.push_along(m.dot(x), m.dot(v));
  if (std::abs(n.dot(m)) > kNarrow) return narrow(one * n + other * m);
  ContactForce contact = ContactForce::along_normal(n, one);
  const double across = contact.frame.row(1).dot(m);
  const bool square =
      std::abs(n.dot(m)) < 1e-9;  // then exact, so that an untouched wall is exactly zero
  contact.along +=
      square ? Axes{0, std::copysign(other, across), 0} : Axes(other * (contact.frame * m));
  contact.force += other * m;
  return contact;
}

/// In the principal directions of both stiffnesses.
ContactForce Corner::narrow(const Axes& force) const EBAC_RT {
  const double a = 2 * first.angle, b = 2 * second.angle;
  const double stiffest =
      0.5 * std::atan2(first.stiffness * std::sin(a) + second.stiffness * std::sin(b),
                       first.stiffness * std::cos(a) + second.stiffness * std::cos(b));
  ContactForce contact = ContactForce::along_normal({std::cos(stiffest), std::sin(stiffest), 0}, 0);
  contact.force = force;
  contact.along = contact.frame * force;
  return contact;
}

ContactForce Disc::contact(const Axes& at, const Axes& v) const EBAC_RT {
  const Axes inwards = Axes{x, y, 0} - Axes{at[0], at[1], 0};
  const double distance = inwards.norm();
  if (!(distance > 0))
    return ContactForce::straight(Axes::Constant(distance));  // dead centre has no direction
  const Axes n = inwards / distance;
  return ContactForce::along_normal(n, push(stiffness, damping, radius - distance, n.dot(v)));
}

Environment fresh(const Environment& environment) {
  const auto* external = std::get_if<External>(&environment);
  if (external == nullptr || external->world == nullptr) return environment;
  return External{external->world->fresh()};
}

ContactForce contact_with_other(const Environment& environment, const Axes& x, const Axes& v,
                                double t) EBAC_RT {
  return std::visit(
      [&](const auto& shape) EBAC_RT {
        if constexpr (requires { shape.contact(x, v, t); }) {
          return shape.contact(x, v, t);
        } else {
          return shape.contact(x, v);
        }
      },
      environment);
}

}  // namespace ebac
