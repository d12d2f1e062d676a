#pragma once

#include <ebac/world/scene.hpp>

namespace chai {

/// A bare force as a contact: it acts along its own direction, and the others turn with that as little as they can.
class ForceContact {
 public:
  /// `force` [N]: with which the handle presses.
  ebac::ContactForce of(const ebac::Axes& force) EBAC_RT {
    const double push = force.norm();
    // Without contact, and for what is no number: the tick ends by a fault then.
    if (!(push > 0)) return ebac::ContactForce::straight(force);
    const ebac::Axes normal = force / push;
    ebac::ContactForce contact{.force = force, .frame = frame_.along(&normal, 1)};
    contact.along = {push, 0, 0};
    contact.turned = !contact.frame.isIdentity(0);
    return contact;
  }

 private:
  ebac::world::TransportedFrame frame_;
};

}  // namespace chai
