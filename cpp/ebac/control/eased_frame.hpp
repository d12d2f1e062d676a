#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ebac/core/realtime.hpp"
#include "ebac/model/contact_force.hpp"

namespace ebac {

/// Directions that share what pushes turn slowly while there is force: as they turn, the force along each changes, and a
/// law would take that for motion into the world or out of it.
class EasedFrame {
 public:
  ContactForce ease(const ContactForce& contact, double dt) EBAC_RT {
    const double wanted = std::atan2(contact.frame(0, 1), contact.frame(0, 0));
    const double off = std::remainder(wanted - angle_, 2 * std::numbers::pi);
    const double most = (std::abs(off) / kLag + kSlowest) * dt;
    const bool arrives = !pushed_ || std::abs(off) <= most;
    angle_ = arrives ? wanted : angle_ + std::copysign(most, off);
    pushed_ = !contact.force.isZero(0);
    if (arrives) return contact;
    ContactForce eased = contact;
    const double c = std::cos(angle_), s = std::sin(angle_);
    eased.frame.topLeftCorner<2, 2>() << c, s, -s, c;
    eased.along = eased.frame * eased.force;
    return eased;
  }

 private:
  static constexpr double kLag = 0.01;     // s
  static constexpr double kSlowest = 0.1;  // rad/s, so that it arrives

  double angle_ = 0;     // rad
  bool pushed_ = false;  // in the last tick
};

}  // namespace ebac
