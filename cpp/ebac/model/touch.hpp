#pragma once

#include "ebac/model/kinematics.hpp"

namespace ebac {

/// What the world does at a point: the force it asks for, and the directions it acts in.
///
/// A law for one port belongs to a direction of the world, not of the device: along the normal it
/// holds a wall up, across it there is nothing to hold. `frame` has these directions as rows
/// (orthonormal), and `along` the force in them, exactly zero where nothing is touched.
struct Touch {
  Axes force = Axes::Zero();
  Axes along = Axes::Zero();
  Jacobian frame = Jacobian::Identity();
  bool turned = false;  // whether the frame is other than the axes of the device

  static Touch straight(const Axes& force) EBAC_RT { return {.force = force, .along = force}; }

  /// A push along the unit vector `n`, in the plane of the first two axes.
  static Touch along_normal(const Axes& n, double push) EBAC_RT {
    Touch touch{.force = push * n, .along = {push, 0, 0}, .turned = n[0] != 1};
    touch.frame.row(0) = n;
    touch.frame.row(1) << -n[1], n[0], 0;
    return touch;
  }
};

}  // namespace ebac
