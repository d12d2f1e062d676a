#include "ebac/model/stepped_plant.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "ebac/core/six_digits.hpp"
#include "ebac/model/lag.hpp"

namespace ebac {

namespace {

constexpr double kAccurate =
    1.0 / 16;                         // time constants in a step; measured, see stepped_plant_test
constexpr double kStable = 1.5;       // time constants in a step; the method diverges from 2.78 on
constexpr double kLag = 1.0 / 2;      // lags in a step
constexpr double kSteps = 64;         // per tick, largest number for a lag or Stribeck friction
constexpr double kUsualSteps = 1024;  // per tick, largest number for accuracy
constexpr double kMostSteps = 16384;  // per tick, largest number for stability
constexpr int kMostEvents =
    256;  // located in one advance; later ones take effect at the end of their step

/// Longest step that is accurate where that is cheap, and stable everywhere.
double longest_step(double rate, double soft_rate, double tick) {
  const double stable = rate * tick / kStable;
  if (!(stable <= kMostSteps)) {
    const std::string text =
        "SteppedPlant: a time constant of " + six_digits(1 / rate) + " s would need " +
        six_digits(stable) + " steps in a tick of " + six_digits(tick) + " s (at most " +
        six_digits(kMostSteps) +
        "); lower Mechanics.cable_stiffness or cable_damping, or raise Mechanics.handle_mass";
    throw std::invalid_argument(text);
  }
  const double accurate = std::min(rate * tick / kAccurate, kUsualSteps);
  const double soft = std::min(soft_rate * tick, kSteps);
  return tick / std::max({1.0, stable, accurate, soft});
}

double lag_rate(double lag) { return lag > 0 ? 1 / (kLag * lag) : 0.0; }

HandBounds bounds_of(const HandForces& forces, const Hand& hand) {
  if (forces) return forces[0].bounds(hand);
  return {.mass = hand.mass, .damping = hand.damping, .stiffness = hand.stiffness};
}

/// The hand of eq. (4) that moves as a hand with these bounds can.
Hand moving_part(const HandBounds& bounds) {
  return {.mass = bounds.mass, .damping = bounds.damping, .stiffness = bounds.stiffness};
}

}  // namespace

SteppedPlant::SteppedPlant(const DeviceModel& device, const Hand& hand, double tick)
    : forces_(hand, device.axes()),
      bounds_(bounds_of(forces_, hand)),
      dynamics_(device, moving_part(bounds_)),
      without_hand_(device, {.mass = 0, .damping = 0, .stiffness = 0}),
      hand_(hand),
      kinematics_(device.kinematics),
      tick_(tick),
      step_(tick),
      torque_per_amp_(device.motor.torque_constant * device.capstan.ratio()),
      ratio_(device.capstan.ratio()),
      current_lag_(device.drive.current_lag),
      sensor_lag_(device.sensor.lag),
      axes_(device.axes()),
      held_(static_cast<bool>(forces_)) {
  double rate = std::max(dynamics_.fastest_rate(), bounds_.rate);
  double stribeck = dynamics_.stribeck_rate();
  if (std::isfinite(hand.release_at)) {
    rate = std::max(rate, without_hand_.fastest_rate());
    stribeck = std::max(stribeck, without_hand_.stribeck_rate());
  }
  const double soft =
      std::max({stribeck / kAccurate, lag_rate(current_lag_), lag_rate(sensor_lag_)});
  step_ = longest_step(rate, soft, tick);
  report();
}

SteppedPlant::Interval SteppedPlant::interval(const Axes& current, double t,
                                              double time) const EBAC_RT {
  Interval all{torque_per_amp_ * current, Axes::Zero(), Axes::Zero(), t};
  for (int i = 0; i < axes_; ++i) {
    const Target target = hand_.target(i, t, time);
    all.target[i] = target.x;
    all.rate[i] = target.rate;
  }
  return all;
}

void SteppedPlant::advance(const Axes& current, double t, std::int64_t quanta) EBAC_RT {
  if (quanta <= 0) return;
  if (t >= hand_.release_at) {
    dynamics_ = without_hand_;
    held_ = false;
  }
  const double time = tick_ * static_cast<double>(quanta) / static_cast<double>(kQuanta);
  interval_ = interval(current, t, time);
  if (current_lag_ == 0) now_.torque = interval_.setpoint;
  now_.time = 0;
  settle();
  const int steps = static_cast<int>(std::ceil(time / step_ * (1 - 1e-12)));
  int events = kMostEvents;
  for (int i = 0; i < steps; ++i) move(time / steps, events);
  report();
}

Load SteppedPlant::load(double time, const Axes& torque, const HandStates& inner) const EBAC_RT {
  return {torque, interval_.target + time * interval_.rate, held_ ? &forces_ : nullptr,
          interval_.t + time, &inner};
}

/// The hand's model after a step that stands.
void SteppedPlant::hand_advanced() EBAC_RT {
  for (int i = 0; i < axes_; ++i) {
    forces_[i].advance({.t = interval_.t + now_.time,
                        .x = now_.motion.x[i],
                        .v = now_.motion.v[i],
                        .target = interval_.target[i] + now_.time * interval_.rate[i]});
  }
}

void SteppedPlant::settle() EBAC_RT {
  contact_ =
      dynamics_.settle(now_.state, load(now_.time, now_.torque, now_.inner), contact_, now_.motion);
}

double SteppedPlant::margin(const Instant& at) const EBAC_RT {
  return dynamics_.margin(at.state, at.motion, contact_);
}

/// Moves by `h`, from event to event.
void SteppedPlant::move(double h, int& events) EBAC_RT {
  const double end = now_.time + h;
  while (now_.time < end) {
    const double left = end - now_.time;
    const Instant next = step(now_, left);
    const bool broken = margin(next) < 0;
    if (broken && events > 0) {
      --events;
      now_ = event(next, left);
    } else {
      now_ = next;
      now_.time = end;
    }
    if (broken) settle();
    if (held_) hand_advanced();
  }
}

/// The first instant beyond the event, to 1e-9 of the step, by the Illinois method (Dowell and
/// Jarratt 1971).
SteppedPlant::Instant SteppedPlant::event(Instant beyond, double h) const EBAC_RT {
  constexpr int kMostTries = 50;
  double low = 0, high = h;
  double above = margin(now_), below = margin(beyond);
  int side = 0;  // of the last try; an end that stays twice counts half
  for (int n = 0; n < kMostTries && high - low > 1e-9 * h; ++n) {
    const double share = above > 0 ? above / (above - below) : 0.5;
    const double length = low + std::clamp(share, 1e-9, 1 - 1e-9) * (high - low);
    const Instant there = step(now_, length);
    const double found = margin(there);
    if (found < 0) {
      high = length;
      below = found;
      beyond = there;
      if (side < 0) above /= 2;
      side = -1;
    } else {
      low = length;
      above = found;
      if (side > 0) below /= 2;
      side = 1;
    }
  }
  return beyond;
}

SteppedPlant::Instant SteppedPlant::step(const Instant& from, double h) const EBAC_RT {
  Instant to;
  to.time = from.time + h;
  Axes mid_torque = interval_.setpoint;
  to.torque = interval_.setpoint;
  if (current_lag_ > 0) {  // the middle stage takes the value that makes the impulse exact
    const LagStep lag(h / current_lag_);
    const Axes rest = from.torque - interval_.setpoint;
    to.torque += lag.decay * rest;
    mid_torque += middle<Axes>(rest, lag.decay * rest, lag.phi[0] * rest);
  }
  HandStates inner = HandStates::Zero();
  const Load mid = load(from.time + h / 2, mid_torque, inner);
  const Load end = load(to.time, to.torque, inner);
  const Motion& m1 = from.motion;
  const auto stage = [&](const Motion& m, double part, const Load& under) EBAC_RT -> Motion {
    if (held_) inner = from.inner + part * m.inner;
    return dynamics_.motion(from.state + part * m.rate, under, contact_);
  };
  const Motion m2 = stage(m1, h / 2, mid);
  const Motion m3 = stage(m2, h / 2, mid);
  const Motion m4 = stage(m3, h, end);
  to.state = from.state + h / 6 * (m1.rate + 2 * (m2.rate + m3.rate) + m4.rate);
  if (held_)
    inner = to.inner = from.inner + h / 6 * (m1.inner + 2 * (m2.inner + m3.inner) + m4.inner);
  to.motion = dynamics_.motion(to.state, end, contact_);
  to.sensor = sensor_lag_ > 0 ? sense(from, m3.f_hand, to, h) : to.motion.f_hand;
  return to;
}

/// The sensor behind its lag. The mean of the hand's force follows from eq. (4) itself; a model's
/// force is taken in the middle of the step.
Axes SteppedPlant::sense(const Instant& from, const Axes& middle_force, const Instant& to,
                         double h) const EBAC_RT {
  const Motion& a = from.motion;
  const Motion& b = to.motion;
  if (held_) {
    return follow<Axes>(LagStep(h / sensor_lag_), from.sensor, a.f_hand, middle_force, b.f_hand);
  }
  const Axes target = interval_.target + (from.time + h / 2) * interval_.rate;
  const Axes mid = middle<Axes>(a.f_hand, b.f_hand, dynamics_.mean_hand_force(a, b, target, h));
  return follow<Axes>(LagStep(h / sensor_lag_), from.sensor, a.f_hand, mid, b.f_hand);
}

void SteppedPlant::report() EBAC_RT {
  Jacobian j = jacobian(kinematics_, now_.state.col(kQ));
  for (int i = axes_; i < kMaxAxes; ++i) j(i, i) = 1;
  const Axes f_motor = j.transpose().inverse() * now_.torque;
  for (int i = 0; i < axes_; ++i) {
    truth_[static_cast<std::size_t>(i)] = {.x = now_.motion.x[i],
                                           .v = now_.motion.v[i],
                                           .f_hand = now_.motion.f_hand[i],
                                           .f_motor = f_motor[i],
                                           .f_sensor = now_.sensor[i],
                                           .energy = now_.state(i, kEnergy)};
    motor_angle_[static_cast<std::size_t>(i)] = ratio_ * dynamics_.motor_joint(now_.state, i);
  }
}

}  // namespace ebac
