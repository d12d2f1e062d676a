#pragma once

#include <cmath>

#include "ebac/model/kinematics.hpp"

namespace ebac {

/// Pose of a lever, and the effect of its geometry on a mass of 1 kg at the handle.
struct Pose {
  Axes x;         // m, handle
  Jacobian j;     // m
  Axes drift;     // m/s^2, J' dq: acceleration of the port at constant joint rates
  Axes inertia;   // m^2, diagonal of the mass matrix
  Axes coriolis;  // m^2/s^2, torque due to the rates alone
  Axes weight;    // m, joint torque per newton of weight
};

inline Pose pose(const Linear& k, const Axes& q, const Axes&) EBAC_RT {
  return {.x = k.forward(q),
          .j = k.jacobian(q),
          .drift = Axes::Zero(),
          .inertia = Axes::Constant(k.radius * k.radius),
          .coriolis = Axes::Zero(),
          .weight = k.weight(q, 1)};
}

/// Lagrange's equations of T = R^2/2 (cos^2 q2 dq1^2 + dq2^2): the mass lies on the sphere, its
/// height included, which the ports x and y do not show.
inline Pose pose(const Gimbal& k, const Axes& q, const Axes& dq) EBAC_RT {
  const double R = k.radius;
  const double s1 = std::sin(q[0]), c1 = std::cos(q[0]);
  const double s2 = std::sin(q[1]), c2 = std::cos(q[1]);
  const double both = dq[0] * dq[1], first = dq[0] * dq[0], second = dq[1] * dq[1];
  return {.x = k.forward(q),
          .j = k.jacobian(q),
          .drift = R * Axes{-s1 * c2 * (first + second) - 2 * c1 * s2 * both, -s2 * second, 0},
          .inertia = R * R * Axes{c2 * c2, 1, 0},
          .coriolis = R * R * s2 * c2 * Axes{-2 * both, first, 0},
          .weight = k.weight(q, 1)};
}

/// The same with a lever r that changes, T = 1/2 (r^2 (cos^2 q2 dq1^2 + dq2^2) + dr^2).
inline Pose pose(const SlidingGimbal& k, const Axes& q, const Axes& dq) EBAC_RT {
  const double r = k.gimbal(q).radius;
  Pose at = pose(k.gimbal(q), q, dq);
  const double grows = k.slide_radius * dq[2];
  const double s1 = std::sin(q[0]), c1 = std::cos(q[0]);
  const double s2 = std::sin(q[1]), c2 = std::cos(q[1]);
  const double both = dq[0] * dq[1], first = dq[0] * dq[0], second = dq[1] * dq[1];
  const Axes turns{c1 * c2 * dq[0] - s1 * s2 * dq[1], c2 * dq[1],
                   -s1 * c2 * dq[0] - c1 * s2 * dq[1]};  // of the lever's direction, per s
  at.x = k.forward(q);
  at.j = k.jacobian(q);
  at.drift[2] = r * (2 * s1 * s2 * both - c1 * c2 * (first + second));
  at.drift += 2 * grows * turns;
  at.inertia[2] = k.slide_radius * k.slide_radius;
  at.coriolis += 2 * r * grows * Axes{c2 * c2 * dq[0], dq[1], 0};
  at.coriolis[2] = -k.slide_radius * r * (c2 * c2 * first + second);
  at.weight = k.weight(q, 1);
  return at;
}

inline Pose pose(const Kinematics& kinematics, const Axes& q, const Axes& dq) EBAC_RT {
  return std::visit([&](const auto& k) { return pose(k, q, dq); }, kinematics);
}

}  // namespace ebac
