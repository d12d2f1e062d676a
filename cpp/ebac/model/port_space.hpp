#pragma once

#include "ebac/model/contact_force.hpp"
#include "ebac/model/kinematics.hpp"

namespace ebac {

/// The handle in space, seen from the ports of a device: what a world meets, and what of its force the ports feel.
///
/// A device of fewer than three axes cannot leave its line, plane or sphere: a force counts as far as it does work
/// there. The origin is the handle at rest in the middle.
class PortSpace {
 public:
  PortSpace(const Kinematics& kinematics, const Axes& x) EBAC_RT;

  /// Of the handle [m].
  const Axes& at() const EBAC_RT { return at_; }
  /// Of the handle, from those of the ports [m/s].
  Axes velocity(const Axes& v) const EBAC_RT { return reach_ * v; }

  /// A contact in space as the ports feel it: force, directions and velocity of the surface in their coordinates.
  ContactForce felt(const ContactForce& contact) const EBAC_RT;

 private:
  Axes felt_velocity(const ContactForce& contact, const Axes& felt) const EBAC_RT;

  static constexpr double kFlattest = 1e-4;  // of the radius squared: the lever never lies flat
  static constexpr double kAcross = 1e-3;    // a direction in which the ports cannot move

  int axes_;
  Axes at_;
  Jacobian reach_ = Jacobian::Zero();
};

}  // namespace ebac
