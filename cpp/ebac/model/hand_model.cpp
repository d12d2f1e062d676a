#include "ebac/model/hand_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "ebac/model/hand.hpp"

namespace ebac {

namespace {

/// Where the handle was: points of its path at most a 64th of the delay apart, cubic between them.
class DelayLine {
 public:
  explicit DelayLine(double delay) : delay_(delay) {}

  void add(const HandMotion& at) EBAC_RT {
    if (count_ > 0 && at.t < point(count_ - 1).t + delay_ / kParts) return;
    if (count_ == points_.size()) {
      first_ = (first_ + 1) % points_.size();
    } else {
      ++count_;
    }
    points_[(first_ + count_ - 1) % points_.size()] = at;
  }

  /// Place and speed `delay` before `t`; at rest at zero before the first point.
  HandMotion before(double t) const EBAC_RT {
    t -= delay_;
    if (count_ < 2 || t <= point(0).t) return {.t = t};
    std::size_t low = 0, high = count_ - 1;
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (point(middle).t <= t ? low : high) = middle;
    }
    const HandMotion& a = point(low);
    const HandMotion& b = point(high);
    const double h = b.t - a.t;
    const double s = (t - a.t) / h;
    const double r = 1 - s;
    const double x =
        r * r * ((1 + 2 * s) * a.x + s * h * a.v) + s * s * ((1 + 2 * r) * b.x - r * h * b.v);
    const double v = 6 * s * r * (b.x - a.x) / h + r * (1 - 3 * s) * a.v + s * (3 * s - 2) * b.v;
    return {.t = t, .x = x, .v = v};
  }

 private:
  static constexpr double kParts = 64;

  const HandMotion& point(std::size_t i) const EBAC_RT {
    return points_[(first_ + i) % points_.size()];
  }

  double delay_;
  std::array<HandMotion, 128> points_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

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
  DelayLine past_;
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
  enum Index { kY, kW, kOwn };

  /// Its motion under the contact's `force` and the spring's target.
  void move(const HandState& z, double target, double force, HandState& change) const EBAC_RT {
    change[kY] = z[kW];
    change[kW] = (stiffness_ * (target - z[kY]) - damping_ * z[kW] - force) / mass_;
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

/// The exponential spring force (exp(x / length) - 1) that goes on straight from a slope on; odd.
class HardeningSpring {
 public:
  HardeningSpring(double slope, double length, double steepest)
      : force_(slope * length),
        length_(length),
        steepest_(std::max(slope, steepest)),
        straight_from_(length * std::log(steepest_ / slope)) {}

  double force(double x) const EBAC_RT {
    const double bent = std::min(std::abs(x), straight_from_);
    const double beyond = std::abs(x) - bent;
    return std::copysign(force_ * std::expm1(bent / length_) + steepest_ * beyond, x);
  }
  double slope(double x) const EBAC_RT {
    return force_ / length_ * std::exp(std::min(std::abs(x), straight_from_) / length_);
  }
  double inverse(double force) const {
    const double f = std::abs(force);
    const double bent = std::min(f, force_ * std::expm1(straight_from_ / length_));
    return std::copysign(length_ * std::log1p(bent / force_) + (f - bent) / steepest_, force);
  }
  double steepest() const { return steepest_; }

 private:
  double force_;          // N
  double length_;         // m
  double steepest_;       // N/m
  double straight_from_;  // m
};

class FingerPadForce final : public BodyBehind {
 public:
  FingerPadForce(const FingerPad& p, const Hand& hand)
      : BodyBehind("FingerPad", hand),
        spring_(p.stiffness, 1 / p.rise, p.stiffest),
        share_{p.fast, p.medium, p.slow} {}

  double force(const HandMotion& at, const HandState& z) const EBAC_RT override {
    double force = spring_.force(z[kY] - at.x);
    for (std::size_t i = 0; i < share_.size(); ++i)
      force -= share_[i] * z[kOwn + static_cast<Eigen::Index>(i)];
    return force;
  }
  HandState rate(const HandMotion& at, const HandState& z) const EBAC_RT override {
    HandState change;
    move(z, at.target, force(at, z), change);
    const double elastic = spring_.force(z[kY] - at.x);
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
      throw std::invalid_argument("LetGo.closed_at = " + std::to_string(p.closed_at) +
                                  " s: must lie at least a ramp after open_at");
    }
    if (!(p.period >= p.closed_at - p.open_at + p.ramp)) {
      throw std::invalid_argument("LetGo.period = " + std::to_string(p.period) +
                                  " s: must be long enough to open and to close");
    }
  }

  double force(const HandMotion& at, const HandState& z) const EBAC_RT override {
    return closed(at.t) * (p_.stiffness * (z[kY] - at.x) + p_.damping * (z[kW] - at.v));
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
