#include "ebac/model/hand_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "ebac/core/check.hpp"
#include "ebac/model/hand.hpp"
#include "ebac/model/hardening_spring.hpp"
#include "ebac/model/path_history.hpp"

namespace ebac {

namespace {

class ReflexForce final : public HandForce {
 public:
  ReflexForce(const Reflex& p, const Hand& hand)
      : p_(p),
        stiffness_(hand.stiffness),
        damping_(hand.damping),
        frequency_(2 * std::numbers::pi * p.activation),
        past_(p.delay) {}

  double force(const HandMotion& at, const HandState& z) const EBAC_RT override {
    return stiffness_ * (at.target - at.x) - damping_ * at.v + z[0];
  }
  HandState rate(const HandMotion& at, const HandState& z) const EBAC_RT override {
    const HandMotion felt = past_.before(at.t);
    const double wanted =
        p_.stretch_gain * stiffness_ * (at.target - felt.x) - p_.velocity_gain * damping_ * felt.v;
    HandState change = HandState::Zero();
    change[0] = z[1];
    change[1] = frequency_ * (frequency_ * (wanted - z[0]) - 2 * p_.activation_damping * z[1]);
    return change;
  }
  void advance(const HandMotion& at) EBAC_RT override { past_.add(at); }
  HandBounds bounds(const Hand& hand) const override {
    HandBounds own = HandForce::bounds(hand);
    own.rate = std::max(1 / p_.delay, 2 * frequency_ * std::max(1.0, p_.activation_damping));
    return own;
  }
  double steady(double target, double x) const override {
    return (1 + p_.stretch_gain) * stiffness_ * (target - x);
  }
  std::unique_ptr<HandForce> clone() const override { return std::make_unique<ReflexForce>(*this); }

 private:
  Reflex p_;
  double stiffness_;
  double damping_;
  double frequency_;  // rad/s
  PathHistory past_;
};

/// The body of a hand behind a contact with the handle: states y [m] and y' [m/s].
class BodyBehind : public HandForce {
 public:
  BodyBehind(const char* name, const Hand& hand)
      : mass_(hand.mass), stiffness_(hand.stiffness), damping_(hand.damping) {
    if (!(mass_ > 0)) {
      throw std::invalid_argument(std::string(name) +
                                  ": Hand.mass = 0 kg: must be positive; it is the body behind");
    }
  }

 protected:
  static constexpr Eigen::Index kPlace = 0;
  static constexpr Eigen::Index kSpeed = 1;
  static constexpr Eigen::Index kOwn = 2;  // first state of the contact

  /// Its motion under the contact's `force` and the spring's target.
  void move(const HandState& z, double target, double force, HandState& change) const EBAC_RT {
    change[kPlace] = z[kSpeed];
    change[kSpeed] = (stiffness_ * (target - z[kPlace]) - damping_ * z[kSpeed] - force) / mass_;
  }
  HandBounds bounds_with(double stiffness, double damping, double rate) const {
    return {.mass = 0,
            .damping = damping,
            .stiffness = stiffness,
            .rate = std::max(
                {rate, std::sqrt((stiffness + stiffness_) / mass_), (damping + damping_) / mass_})};
  }
  double stiffness() const { return stiffness_; }

 private:
  double mass_;
  double stiffness_;
  double damping_;
};

class FingerPadForce final : public BodyBehind {
 public:
  FingerPadForce(const FingerPad& p, const Hand& hand)
      : BodyBehind("FingerPad", hand),
        spring_(p.stiffness, 1 / p.rise, p.stiffest),
        share_{p.fast, p.medium, p.slow} {}

  double force(const HandMotion& at, const HandState& z) const EBAC_RT override {
    double force = spring_.force(z[kPlace] - at.x);
    for (std::size_t i = 0; i < share_.size(); ++i)
      force -= share_[i] * z[kOwn + static_cast<Eigen::Index>(i)];
    return force;
  }
  HandState rate(const HandMotion& at, const HandState& z) const EBAC_RT override {
    HandState change;
    move(z, at.target, force(at, z), change);
    const double elastic = spring_.force(z[kPlace] - at.x);
    for (std::size_t i = 0; i < share_.size(); ++i) {
      const auto own = kOwn + static_cast<Eigen::Index>(i);
      change[own] = (elastic - z[own]) / FingerPad::kTau[i];
    }
    return change;
  }
  HandBounds bounds(const Hand&) const override {
    return bounds_with(spring_.steepest(), 0, 1 / FingerPad::kTau[0]);
  }
  double steady(double target, double x) const override {
    const double left = 1 - share_[0] - share_[1] - share_[2];
    double low = 0, high = stiffness() * std::abs(target - x);
    for (int i = 0; i < 100; ++i) {
      const double f = (low + high) / 2;
      const double given = stiffness() * (std::abs(target - x) - spring_.inverse(f / left));
      (given > f ? low : high) = f;
    }
    return std::copysign(low, target - x);
  }
  std::unique_ptr<HandForce> clone() const override {
    return std::make_unique<FingerPadForce>(*this);
  }

 private:
  HardeningSpring spring_;
  std::array<double, 3> share_;
};

class NonlinearGripForce final : public HandForce {
 public:
  NonlinearGripForce(const NonlinearGrip& p, const Hand& hand)
      : stiffness_(hand.stiffness),
        damping_(hand.damping),
        spring_(std::max(stiffness_, kLeast), p.force / std::max(stiffness_, kLeast),
                p.stiffest * std::max(stiffness_, kLeast)) {}

  double force(const HandMotion& at, const HandState&) const EBAC_RT override {
    if (!(stiffness_ > 0)) return -damping_ * at.v;
    const double away = at.target - at.x;
    return spring_.force(away) - damping_ * std::sqrt(spring_.slope(away) / stiffness_) * at.v;
  }
  HandBounds bounds(const Hand& hand) const override {
    const double stiffer = spring_.steepest() / std::max(stiffness_, kLeast);
    return {.mass = hand.mass,
            .damping = damping_ * std::sqrt(stiffer),
            .stiffness = stiffness_ * stiffer};
  }
  double steady(double target, double x) const override {
    return force({.x = x, .target = target}, HandState::Zero());
  }
  std::unique_ptr<HandForce> clone() const override {
    return std::make_unique<NonlinearGripForce>(*this);
  }

 private:
  static constexpr double kLeast = 1e-9;  // N/m, in place of none

  double stiffness_;
  double damping_;
  HardeningSpring spring_;
};

class LetGoForce final : public BodyBehind {
 public:
  LetGoForce(const LetGo& p, const Hand& hand) : BodyBehind("LetGo", hand), p_(p) {
    if (!(p.closed_at >= p.open_at + p.ramp)) {
      throw std::invalid_argument("LetGo.closed_at = " + shortest(p.closed_at) +
                                  " s: must lie at least a ramp after open_at");
    }
    if (!(p.period >= p.closed_at - p.open_at + p.ramp)) {
      throw std::invalid_argument("LetGo.period = " + shortest(p.period) +
                                  " s: must be long enough to open and to close");
    }
  }

  double force(const HandMotion& at, const HandState& z) const EBAC_RT override {
    return closed(at.t) * (p_.stiffness * (z[kPlace] - at.x) + p_.damping * (z[kSpeed] - at.v));
  }
  HandState rate(const HandMotion& at, const HandState& z) const EBAC_RT override {
    const double share = closed(at.t);
    HandState change = HandState::Zero();
    move(z, share * at.target + (1 - share) * at.x, force(at, z), change);
    return change;
  }
  HandBounds bounds(const Hand&) const override {
    return bounds_with(p_.stiffness, p_.damping, 2 / p_.ramp);
  }
  double steady(double target, double x) const override {
    if (std::isfinite(p_.period)) return HandForce::steady(target, x);
    return stiffness() * p_.stiffness / (stiffness() + p_.stiffness) * (target - x);
  }
  std::unique_ptr<HandForce> clone() const override { return std::make_unique<LetGoForce>(*this); }

 private:
  /// How far the grip is closed, 0 to 1.
  double closed(double t) const EBAC_RT {
    const double since = t - p_.open_at;
    if (!(since > 0)) return 1;
    const double now = std::isfinite(p_.period) ? std::fmod(since, p_.period) : since;
    const MinimumJerk ramp{.target = 1, .duration = p_.ramp};
    return 1 - ramp.position(now) + ramp.position(now - (p_.closed_at - p_.open_at));
  }

  LetGo p_;
};

struct Maker {
  const Hand& hand;
  int axis;
  using Made = std::unique_ptr<HandForce>;

  Made operator()(std::monostate) const { return nullptr; }
  Made operator()(const Reflex& p) const { return std::make_unique<ReflexForce>(p, hand); }
  Made operator()(const FingerPad& p) const { return std::make_unique<FingerPadForce>(p, hand); }
  Made operator()(const NonlinearGrip& p) const {
    return std::make_unique<NonlinearGripForce>(p, hand);
  }
  Made operator()(const LetGo& p) const { return std::make_unique<LetGoForce>(p, hand); }
  Made operator()(const OwnHand& own) const {
    Made made = own.force->clone();
    made->start(axis);
    return made;
  }
};

}  // namespace

HandBounds HandForce::bounds(const Hand& hand) const {
  return {.mass = hand.mass, .damping = hand.damping, .stiffness = hand.stiffness};
}

std::unique_ptr<HandForce> hand_force(const Hand& hand, int axis) {
  return std::visit(Maker{hand, axis}, hand.model);
}

HandForces::HandForces(const HandForces& other) {
  for (std::size_t i = 0; i < axis_.size(); ++i) {
    if (other.axis_[i] != nullptr) axis_[i] = other.axis_[i]->clone();
  }
}

HandForces::HandForces(const Hand& hand, int axes) {
  for (int i = 0; i < axes; ++i) axis_[static_cast<std::size_t>(i)] = hand_force(hand, i);
}

}  // namespace ebac
