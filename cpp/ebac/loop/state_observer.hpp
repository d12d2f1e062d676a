#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "ebac/core/device.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/loop/account_watch.hpp"
#include "ebac/loop/axis_observer.hpp"
#include "ebac/loop/observing.hpp"
#include "ebac/model/device.hpp"

namespace ebac {

struct Pose;

/// State of a whole device: an observer for each axis, in the joints, where counts and currents are,
/// and the share of their estimate that is used.
class StateObserver {
 public:
  StateObserver(const DeviceModel& device, const Observing& observing);

  bool on() const EBAC_RT { return observing_.on; }

  /// Share of the estimate in what world and law are given.
  double weight() const EBAC_RT { return observing_.acts ? weight_ : 0.0; }

  /// Time from a tick of `dt` to when its command acts, in the middle of its interval [s].
  double ahead(double dt) const EBAC_RT {
    return (observing_.params.delay + 0.5) * dt + observing_.params.current_lag;
  }

  /// Whether the law uses the estimate; where it begins to, the estimate fades in.
  void act(bool observed) EBAC_RT {
    const bool acts = on() && (observing_.params.every_law || observed);
    if (acts && !observing_.acts) weight_ = 0;
    observing_.acts = acts;
  }

  /// Whether the account of the law is `drained` in this tick, by which the law may give the estimate up.
  void heed(bool drained, double dt, std::span<const Axis> axes) EBAC_RT;

  /// Begins anew in the next tick.
  void forget() EBAC_RT { forgot_ = true; }

  /// counts, f_meas, currents -> est; `counted` is, for each axis, whether new counts came.
  void step(const Reading& reading, const std::array<bool, kMaxAxes>& counted, double dt,
            std::span<Axis> axes) EBAC_RT;

 private:
  static constexpr double kUnbroken = 0.1;  // s without a failure, until the estimate is used again

  Fallback failure(const Reading& reading, std::size_t axes) const EBAC_RT;
  void trust(const Reading& reading, double dt, std::size_t axes) EBAC_RT;
  void teach(std::span<const Axis> axes) EBAC_RT;
  double mass_share(const Pose& at, Eigen::Index axis) const EBAC_RT;
  void step_general(const Reading& reading, const std::array<bool, kMaxAxes>& counted, double dt,
                    std::span<Axis> axes) EBAC_RT;

  const AxisObserver& follow(std::size_t axis, const Joint& joint, double force,
                             const Reading& reading, bool counted, double dt) EBAC_RT;
  void enter(std::size_t axis, Port& port) const EBAC_RT;

  Kinematics kinematics_;
  bool linear_;
  Axes travel_;           // m, way at the handle per joint angle
  Axes force_per_amp_;    // N/A, at the handle
  double handle_mass_;    // kg
  double slide_mass_;     // kg, on the last axis, in the middle
  double handle_weight_;  // N
  Observing observing_;
  std::array<AxisObserver, kMaxAxes> observer_;
  bool forgot_ = false;  // begins in this tick
  AccountWatch account_;
  double weight_ = 1;  // of the estimate
  Fallback fallback_ = Fallback::kNone;
  double unbroken_ = kUnbroken;  // s, without a failure
};

// Inline, as every line of a tick of the usual device; state_observer.cpp has the others.

/// One axis in its joint: s = R q (of a slide its own R), and `force` along it.
inline const AxisObserver& StateObserver::follow(std::size_t axis, const Joint& joint, double force,
                                                 const Reading& reading, bool counted,
                                                 double dt) EBAC_RT {
  AxisObserver& observer = observer_[axis];
  const auto e = static_cast<Eigen::Index>(axis);
  const double s = travel_[e] * joint.q;
  if (dt > 0) {
    const Aged encoder{s, reading.counts_age[axis]};
    observer.give(force_per_amp_[e] * joint.current);
    observer.step(counted ? std::optional(encoder) : std::nullopt, {force, reading.force_age},
                  force_per_amp_[e] * joint.current_applied, dt);
  } else {
    observer.start(s, force);
  }
  return observer;
}

inline void StateObserver::enter(std::size_t axis, Port& port) const EBAC_RT {
  Estimate& est = port.est;
  est.disturbance = observer_[axis].disturbance();
  est.bound = observing_.params.count / 2 + std::abs(port.x - est.x);
  est.weight = weight_;
  est.fallback = static_cast<int>(fallback_);
}

/// What is wrong with the estimate's inputs or its model in this tick.
inline Fallback StateObserver::failure(const Reading& reading, std::size_t axes) const EBAC_RT {
  constexpr double kContradicted = 0.5, kAgrees = 0.1;
  double contradicted = 0;
  for (std::size_t i = 0; i < axes; ++i) {
    contradicted = std::max(contradicted, observer_[i].contradicted());
  }
  const bool model_fails = contradicted > (fallback_ == Fallback::kModel ? kAgrees : kContradicted);
  const bool fresh = reading.force_age <= observing_.params.force_age;  // not so for NaN
  return reading.force_status != SensorStatus::kGood ? Fallback::kForceStatus
         : !fresh                                    ? Fallback::kForceStale
         : model_fails                               ? Fallback::kModel
         : account_.given_up()                       ? Fallback::kAccount
                                                     : Fallback::kNone;
}

/// Fades the estimate out in 20 ms where its inputs or its model fail, and in again when neither has failed for a while:
/// one that came back between two short failures, in a contact, would give the law a new account each time.
inline void StateObserver::trust(const Reading& reading, double dt, std::size_t axes) EBAC_RT {
  constexpr double kFade = 0.02;  // s
  const Fallback failed = failure(reading, axes);
  unbroken_ = failed == Fallback::kNone ? std::min(kUnbroken, unbroken_ + dt) : 0.0;
  if (!observing_.acts) {
    fallback_ = Fallback::kOff;
    weight_ = 0;
  } else if (failed != Fallback::kNone || unbroken_ < kUnbroken) {
    if (failed != Fallback::kNone) fallback_ = failed;
    weight_ = std::max(0.0, weight_ - dt / kFade);
  } else if (weight_ < 1 || fallback_ != Fallback::kNone) {
    fallback_ = Fallback::kNone;
    weight_ = dt > 0 && !forgot_ ? std::min(1.0, weight_ + dt / kFade) : 1.0;
  }
}

inline void StateObserver::heed(bool drained, double dt, std::span<const Axis> axes) EBAC_RT {
  AccountWatch::Tick now{.drained = drained};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Port& port = axes[i].port;
    now.contact = now.contact || port.f_env != 0;
    now.speed = std::max(now.speed, std::abs(port.est.v));
    now.rough = std::max(now.rough, observer_[i].rough());
  }
  account_.step(now, dt);
}

inline void StateObserver::step(const Reading& reading, const std::array<bool, kMaxAxes>& counted,
                                double dt, std::span<Axis> axes) EBAC_RT {
  trust(reading, dt, axes.size());
  if (observing_.params.learn_scale) teach(axes);
  if (forgot_) dt = 0;
  forgot_ = false;
  if (linear_) {  // the general case below, with J = R
    for (std::size_t i = 0; i < axes.size(); ++i) {
      Port& port = axes[i].port;
      const AxisObserver& observer = follow(i, axes[i].joint, port.f_meas, reading, counted[i], dt);
      Estimate& est = port.est;
      est.x = observer.x();
      est.dx = dt > 0 ? observer.moved() : 0.0;
      est.v = observer.v();
      const AxisObserver::Motion then = observer.predict();
      est.x_act = then.x;
      est.v_act = then.v;
      enter(i, port);
    }
  } else {
    step_general(reading, counted, dt, axes);
  }
}

}  // namespace ebac
