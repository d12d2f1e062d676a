#pragma once

#include <algorithm>
#include <span>

#include "ebac/core/sample.hpp"
#include "ebac/model/contact_force.hpp"

namespace ebac {

/// Another law or another world takes over while a hand is in contact: the force makes no step, and the hand is not
/// thrown out of a place that the new contact would not have let it reach.
///
///   1. The law is shown a share of the contact's force, at first so much that it is the force of the last tick. The
///      share grows by a factor e in a quarter of a second. Of a contact that is lost nothing is held back any more.
///   2. The command passes from the force of the last tick to the law's within 50 ms, and lies between the two. What is
///      left of the force of the last tick goes down with the contact's: behind it nothing would stop the hand.
class TakeOver {
 public:
  static constexpr double kPass = 0.05;  // s
  static constexpr double kGrow = 0.25;  // s

  /// From the next tick on, also where an earlier one has not ended.
  void begin() EBAC_RT {
    begun_ = false;
    left_ = 1;
  }
  bool on() const EBAC_RT { return left_ > 0 || share_ < 1; }

  /// Before the law's step, with the forces of the last tick in `f_cmd`: the contact as the law is shown it.
  ContactForce shown(const ContactForce& contact, std::span<const Axis> axes) EBAC_RT {
    if (begun_) {
      go_on(contact, axes[0].port.dt);
    } else {
      start(contact, axes);
    }
    ContactForce part = contact;
    part.force *= share_;
    part.along *= share_;
    part.stiffness *= share_;
    return part;
  }

  /// After the law's step: the command.
  void pass(std::span<Axis> axes) const EBAC_RT {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      double& f = axes[i].port.f_cmd;
      f += left_ * (lasts_ * from_[static_cast<Eigen::Index>(i)] - f);
    }
  }

 private:
  void start(const ContactForce& contact, std::span<const Axis> axes) EBAC_RT {
    begun_ = true;
    for (std::size_t i = 0; i < axes.size(); ++i)
      from_[static_cast<Eigen::Index>(i)] = axes[i].port.f_cmd;
    met_ = contact.force.norm();
    lasts_ = 1;
    share_ = met_ > 0 ? std::clamp(from_.dot(contact.force) / (met_ * met_), 0.0, 1.0) : 1;
  }

  void go_on(const ContactForce& contact, double dt) EBAC_RT {
    const double size = contact.force.norm();
    if (size == 0) share_ = 1;
    if (size == 0 && met_ > 0) {  // it is lost, and with it the force before
      left_ = 0;
      return;
    }
    left_ = std::max(0.0, left_ - dt / kPass);
    lasts_ = size < met_ ? size / met_ : 1;
    share_ = std::min(1.0, share_ + (share_ + kLeast) * dt / kGrow);
  }

  static constexpr double kLeast = 0.01;  // lets a share of zero grow

  bool begun_ = true;
  double left_ = 0;           // how much of the passage
  double share_ = 1;          // of the contact's force
  Axes from_ = Axes::Zero();  // N, of the tick before
  double lasts_ = 1;          // share of it
  double met_ = 0;            // N, of the contact in the first tick
};

}  // namespace ebac
