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
///   2. Part of the first command's difference from the last one is the change's. It fades within 50 ms, and with the
///      force of the contact, since behind it nothing would stop the hand. Of another world that part is at most the
///      difference of the two forces at the same place (where several axes are in contact all of it, for their
///      directions begin anew). Of another law it is the difference of each tick, as a law without memory needs some
///      to reach its force, and of the force only what was there in the first tick; it ends where a contact begins.
///      The command lies between the law's and that of the last tick before.
///   3. What the contact stores by the change, or no longer stores, no motion has paid for: accounts get it.
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
    if (before == now) return;                   // as where neither is touched
    const bool known = begun_ || !another_law_;  // or else the law has been given no force yet
    const bool along = before.dot(now) > 0;
    const Axes shown = share_ * before;
    stiffer_ = known && along ? now.norm() / shown.norm() : 0;
    share_ = part(shown, now);
    grows_ = 1 - share_;
    gives_ = part(gives_ * before, now);
    before_ = shown;
    now_ = now;
    begin(false);
  }

  /// After each tick: how much of the contact's force its law gives. One that swings gives little at times.
  void watch(std::span<const Axis> axes) EBAC_RT {
    const Axes contact = of_all(axes, &Axis::port, &Port::f_env);
    const double now = part(of_all(axes, &Axis::port, &Port::f_cmd), contact);
    touched_ = !contact.isZero(0);
    gives_ = std::max(now, gives_ + (now - gives_) * axes[0].port.dt / kLately);
  }

  bool on() const EBAC_RT { return left_ > 0 || share_ < 1; }
  /// Whether the law is another one: all that the contact stores is news to it.
  bool another_law() const EBAC_RT { return another_law_; }
  /// Of what the contact that is shown stores, the part that has come in this tick with no motion; below zero where
  /// it stored more before.
  double came() const EBAC_RT { return came_; }
  /// In the tick in which all of another world's force is shown, the part of what it stores that has come by the change.
  double in_all() const EBAC_RT { return full_ ? grows_ : 0; }

  /// Before the law's step, with the forces of the last tick in `f_cmd`: the contact as the law is shown it.
  ContactForce shown(const ContactForce& contact, std::span<const Axis> axes) EBAC_RT {
    first_ = !begun_;
    const double before = share_;
    if (first_) {
      meet(contact, axes);
      scaled_ = stiffer_ > 0 ? share_ * stiffer_ : 1;
      came_ = stiffer_ > 0 ? 1 - 1 / scaled_ : 1;
    } else {
      go_on(contact, axes[0].port.dt);
      scaled_ = contact.force.isZero(0) ? 1 : share_ / before;
      came_ = 1 - 1 / scaled_;
    }
    full_ = share_ == 1 && (first_ || before < 1);
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
    if (another_law_) {
      differs_ = from_ - was_there_ * command;
    } else if (first_) {
      const Axes most = before_ - share_ * now_ + (1 - axes[0].port.dt / kPass) * passing_;
      differs_ = from_ - command;
      if (axes.size() == 1 || !touched_) differs_ = between(differs_, Axes::Zero(), most);
    }
    const Axes passed = between(command + left_ * lasts_ * differs_, command, from_);
    passing_ = passed - command;
    for (std::size_t i = 0; i < axes.size(); ++i)
      axes[i].port.f_cmd = passed[static_cast<Eigen::Index>(i)];
  }

 private:
  static Axes between(const Axes& value, const Axes& a, const Axes& b) EBAC_RT {
    return value.cwiseMax(a.cwiseMin(b)).cwiseMin(a.cwiseMax(b));
  }

  /// How much of a force another one is, along it.
  static double part(const Axes& of, const Axes& whole) EBAC_RT {
    const double size = whole.squaredNorm();
    return size > 0 ? std::clamp(of.dot(whole) / size, 0.0, 1.0) : 1;
  }

  /// The share of a contact that throws nobody.
  static double harmless(const ContactForce& contact) EBAC_RT {
    const double size = contact.force.norm();
    const double stored = 0.5 * size * contact.depth;  // J; 0 where a world has no depth
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
    lasts_ = was_there_ = 1;
    share_ = std::max(share_, harmless(contact));
    if (another_law_ && !touched_ && met_ > 0) left_ = 0;  // it lands in this tick
  }

  void go_on(const ContactForce& contact, double dt) EBAC_RT {
    const double size = contact.force.norm();
    if (size == 0) share_ = 1;
    const bool lost = size == 0 && met_ > 0;
    const bool lands = size > 0 && met_ == 0;
    if (lost || (lands && another_law_)) {  // what passes has nothing to do with it
      left_ = 0;
      return;
    }
    left_ = std::max(0.0, left_ - dt / kPass);
    lasts_ = size < met_ ? size / met_ : 1;
    was_there_ = size > met_ ? met_ / size : 1;
    share_ = std::min(1.0, share_ + (share_ + kLeast) * dt / kGrow);
    share_ = std::max(share_, harmless(contact));
  }

  static constexpr double kLeast = 0.01;  // lets a share of zero grow

  bool touched_ = false;  // whether there was a contact in the last tick
  bool begun_ = true;
  bool first_ = false;           // whether this is the first tick
  bool another_law_ = false;     // or else another world
  double left_ = 0;              // how much of the difference
  double share_ = 1;             // of the contact's force
  double gives_ = 1;             // of that force, what the law has given lately
  Axes from_ = Axes::Zero();     // N, the command of the tick before
  Axes differs_ = Axes::Zero();  // N, by which it differs from the law's
  Axes passing_ = Axes::Zero();  // N, what is left of that in the command
  Axes before_ = Axes::Zero();   // N, what was shown of the world before
  Axes now_ = Axes::Zero();      // N, at the same place, of the world that takes over
  double stiffer_ = 0;  // of the world to what was shown of the one before; 0 where nothing was
  double scaled_ = 1;
  double came_ = 0;
  double grows_ = 0;  // of the force, what was not shown of another world at first
  bool full_ = false;
  double lasts_ = 1;      // of the contact's force in the first tick
  double was_there_ = 1;  // of the contact's force, in the first tick
  double met_ = 0;        // N, that force
};

}  // namespace ebac
