#pragma once

#include <algorithm>
#include <span>

#include "ebac/core/sample.hpp"
#include "ebac/model/contact_force.hpp"
#include "ebac/model/of_all.hpp"

namespace ebac {

/// Another law or another world takes over while a hand is in contact: the force makes no step, and the hand is not
/// thrown out of a place that the new contact would not have let it reach.
///
///   1. The law is shown a share of the contact's force: of another world as much as was shown of the one before at the
///      same place, of another law as much as the law before has given of it lately. The share grows by a factor e in a
///      quarter of a second. A contact that stores less than a millijoule is shown whole, and so is a small force, and
///      all after a contact is lost. To the law none of this is a motion: what it remembers of the contact is scaled.
///   2. What the command of the first tick differs by from that of the last one fades within 50 ms, and with the force
///      of the contact: behind it nothing would stop the hand. A law without memory needs some ticks to reach its force,
///      so of another law the difference is that of each tick. The command lies between the law's and that of the last
///      tick before.
class TakeOver {
 public:
  static constexpr double kPass = 0.05;    // s
  static constexpr double kGrow = 0.25;    // s
  static constexpr double kLately = 0.05;  // s
  static constexpr double kThrows = 1e-3;  // J
  static constexpr double kSmall = 3.5;    // N, above what the search for signs pushes with

  /// Another law, from the next tick on.
  void law() EBAC_RT {
    share_ = gives_;
    stiffer_ = 0;
    begin(true);
  }

  /// Another world, from the next tick on; `before` and `now` are its forces at the place of the last one.
  void world(const Axes& before, const Axes& now) EBAC_RT {
    const bool known = begun_ || !another_law_;  // or else the law has been given no force yet
    const bool along = before.dot(now) > 0;
    stiffer_ = known && along ? now.norm() / (share_ * before.norm()) : 0;
    share_ = part(share_ * before, now);
    gives_ = part(gives_ * before, now);
    begin(false);
  }

  /// After each tick: how much of the contact's force its law gives. One that swings gives little at times.
  void watch(std::span<const Axis> axes) EBAC_RT {
    const double now =
        part(of_all(axes, &Axis::port, &Port::f_cmd), of_all(axes, &Axis::port, &Port::f_env));
    gives_ = std::max(now, gives_ + (now - gives_) * axes[0].port.dt / kLately);
  }

  bool on() const EBAC_RT { return left_ > 0 || share_ < 1; }
  /// Whether the contact has come by itself, without a hand's work, until this tick.
  bool gave() const EBAC_RT { return share_ < 1 || left_ == 0; }

  /// Before the law's step, with the forces of the last tick in `f_cmd`: the contact as the law is shown it.
  ContactForce shown(const ContactForce& contact, std::span<const Axis> axes) EBAC_RT {
    first_ = !begun_;
    const double before = share_;
    if (first_) {
      meet(contact, axes);
      scaled_ = stiffer_ > 0 ? share_ * stiffer_ : 1;
    } else {
      go_on(contact, axes[0].port.dt);
      scaled_ = contact.force.isZero(0) ? 1 : share_ / before;
    }
    ContactForce shown = contact;
    shown.force *= share_;
    shown.along *= share_;
    shown.stiffness *= share_;
    return shown;
  }

  /// How many times as stiff the contact that is shown has become, with no motion.
  double scaled() const EBAC_RT { return scaled_; }

  /// After the law's step: the command.
  void pass(std::span<Axis> axes) EBAC_RT {
    const Axes command = of_all(axes, &Axis::port, &Port::f_cmd);
    if (another_law_ || first_) own_ = command;
    const Axes passing = (command + left_ * lasts_ * (from_ - own_))
                             .cwiseMax(command.cwiseMin(from_))
                             .cwiseMin(command.cwiseMax(from_));
    for (std::size_t i = 0; i < axes.size(); ++i)
      axes[i].port.f_cmd = passing[static_cast<Eigen::Index>(i)];
  }

 private:
  /// How much of a force another one is, along it.
  static double part(const Axes& of, const Axes& whole) EBAC_RT {
    const double size = whole.squaredNorm();
    return size > 0 ? std::clamp(of.dot(whole) / size, 0.0, 1.0) : 1;
  }

  /// The share of a contact that throws nobody.
  static double harmless(const ContactForce& contact) EBAC_RT {
    const double size = contact.force.norm();
    const double stored = 0.5 * size * contact.depth;  // J; 0 where a world tells no depth
    const double by_force = size > kSmall ? kSmall / size : 1;
    return stored > 0 ? std::max(by_force, std::min(1.0, kThrows / stored)) : by_force;
  }

  void begin(bool another_law) EBAC_RT {
    another_law_ = another_law || (another_law_ && !begun_);
    begun_ = false;
    left_ = 1;
  }

  void meet(const ContactForce& contact, std::span<const Axis> axes) EBAC_RT {
    begun_ = true;
    from_ = of_all(axes, &Axis::port, &Port::f_cmd);
    met_ = contact.force.norm();
    lasts_ = 1;
    share_ = std::max(share_, harmless(contact));
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
    share_ = std::max(share_, harmless(contact));
  }

  static constexpr double kLeast = 0.01;  // lets a share of zero grow

  bool begun_ = true;
  bool first_ = false;        // whether this is the first tick
  bool another_law_ = false;  // or else another world
  double left_ = 0;           // how much of the difference
  double share_ = 1;          // of the contact's force
  double gives_ = 1;          // of that force, what the law has given lately
  Axes from_ = Axes::Zero();  // N, the command of the tick before
  Axes own_ = Axes::Zero();   // N, the law's
  double stiffer_ = 0;  // of the world to what was shown of the one before; 0 where nothing was
  double scaled_ = 1;
  double lasts_ = 1;  // of the contact's force in the first tick
  double met_ = 0;    // N, that force
};

}  // namespace ebac
