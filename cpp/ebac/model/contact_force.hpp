#pragma once

#include "ebac/model/kinematics.hpp"

namespace ebac {

/// Force of the virtual world at a point, and the directions in which it acts.
///
/// A law for one port belongs to a direction of the world, not of the device: along the normal it
/// renders a wall, across the normal there is nothing to render. `frame` has these directions as
/// rows (orthonormal), and `along` the force in them, exactly zero without contact.
struct ContactForce {
  Axes force = Axes::Zero();
  Axes along = Axes::Zero();
  Jacobian frame = Jacobian::Identity();
  Axes velocity = Axes::Zero();  // m/s, of the surface itself, in the axes of the device
  bool turned = false;           // whether the frame is other than the axes of the device
  bool shared = false;   // whether several surfaces push, none of which has a direction of its own
  double depth = 0;      // m, behind the surface; 0 where a world does not tell
  double stiffness = 0;  // N/m, of the surface at this depth

  /// The push that is shared by the directions of `frame`; one that is without force has exactly none.
  void set_force(const Axes& push) EBAC_RT {
    force = push;
    along = frame * push;
    along = (along.array().abs() < kRounding * push.norm()).select(0, along);
  }

  static ContactForce straight(const Axes& force) EBAC_RT {
    return {.force = force, .along = force};
  }

  /// A push along the unit vector `n`, in the plane of the first two axes.
  static ContactForce along_normal(const Axes& n, double push) EBAC_RT {
    ContactForce contact{.force = push * n, .along = {push, 0, 0}, .turned = n[0] != 1};
    contact.frame.row(0) = n;
    contact.frame.row(1) << -n[1], n[0], 0;
    return contact;
  }

 private:
  static constexpr double kRounding = 1e-12;  // of a force
};

}  // namespace ebac
