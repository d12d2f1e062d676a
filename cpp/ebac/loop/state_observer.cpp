#include "ebac/loop/state_observer.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "ebac/loop/of_all.hpp"
#include "ebac/model/pose.hpp"

namespace ebac {

StateObserver::StateObserver(const DeviceModel& device, const Observing& observing)
    : kinematics_(device.kinematics),
      linear_(std::holds_alternative<Linear>(device.kinematics)),
      travel_(travel(device.kinematics)),
      force_per_amp_(device.motor.torque_constant * device.capstan.ratio() / travel_.array()),
      slides_(std::holds_alternative<SlidingGimbal>(device.kinematics)),
      handle_mass_(device.mechanics.handle_mass),
      slide_mass_(device.mass(device.axes() - 1)),
      observing_(observing),
      observer_{AxisObserver(observing.params), AxisObserver(observing.params),
                AxisObserver(observing.params)} {}

/// One axis in its joint: s = R q (of a slide its own R), and `force` along it.
const AxisObserver& StateObserver::follow(std::size_t axis, const Joint& joint, double force,
                                          const Reading& reading, bool counted, double dt) EBAC_RT {
  AxisObserver& observer = observer_[axis];
  const auto e = static_cast<Eigen::Index>(axis);
  const double s = travel_[e] * joint.q;
  if (dt > 0) {
    const Aged encoder{s, reading.counts_age[axis]};
    observer.give(force_per_amp_[e] * joint.current);
    observer.step(counted ? std::optional(encoder) : std::nullopt, {force, reading.force_age},
                  force_per_amp_[e] * joint.current_applied, dt);
  } else {
    observer.start(s);
  }
  return observer;
}

void StateObserver::enter(std::size_t axis, Port& port) const EBAC_RT {
  Estimate& est = port.est;
  est.disturbance = observer_[axis].disturbance();
  est.bound = observing_.params.count / 2 + std::abs(port.x - est.x);
  est.weight = weight_;
  est.fallback = static_cast<int>(fallback_);
}

/// What is wrong with the estimate's inputs or its model in this tick.
Fallback StateObserver::failure(const Reading& reading, std::size_t axes) const EBAC_RT {
  constexpr double kContradicted = 0.5, kAgrees = 0.1;
  double contradicted = 0;
  for (std::size_t i = 0; i < axes; ++i) {
    contradicted = std::max(contradicted, observer_[i].contradicted());
  }
  const bool model_fails = contradicted > (fallback_ == Fallback::kModel ? kAgrees : kContradicted);
  return reading.force_status != SensorStatus::kGood       ? Fallback::kForceStatus
         : reading.force_age > observing_.params.force_age ? Fallback::kForceStale
         : model_fails                                     ? Fallback::kModel
         : account_.given_up()                             ? Fallback::kAccount
                                                           : Fallback::kNone;
}

/// Fades the estimate out in 20 ms where its inputs or its model fail, and in again when neither has failed for a while:
/// one that came back between two short failures, in a contact, would give the law a new account each time.
void StateObserver::trust(const Reading& reading, double dt, std::size_t axes) EBAC_RT {
  constexpr double kFade = 0.02;  // s
  const Fallback failed = failure(reading, axes);
  unbroken_ = failed == Fallback::kNone ? std::min(kUnbroken, unbroken_ + dt) : 0.0;
  if (!observing_.acts) {
    fallback_ = Fallback::kOff;
    weight_ = 0;
  } else if (failed != Fallback::kNone || unbroken_ < kUnbroken) {
    if (failed != Fallback::kNone) fallback_ = failed;
    weight_ = std::max(0.0, weight_ - dt / kFade);
  } else {
    fallback_ = Fallback::kNone;
    weight_ = dt > 0 && !forgot_ ? std::min(1.0, weight_ + dt / kFade) : 1.0;
  }
}

void StateObserver::heed(bool drained, double dt, std::span<const Axis> axes) EBAC_RT {
  AccountWatch::Tick now{.drained = drained};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Port& port = axes[i].port;
    now.contact = now.contact || port.f_env != 0;
    now.speed = std::max(now.speed, std::abs(port.est.v));
    now.rough = std::max(now.rough, observer_[i].rough());
  }
  account_.step(now, dt);
}

/// The mass of an axis over that of the first in the middle. A lever that slides changes the handle's part of it.
double StateObserver::mass_share(const Pose& at, Eigen::Index axis) const EBAC_RT {
  const double share = at.inertia[axis] / (travel_[axis] * travel_[axis]);
  if (!slides_) return share;
  const double middle = axis == 2 ? slide_mass_ : observing_.params.mass;
  return (middle + handle_mass_ * (share - 1)) / observing_.params.mass;
}

/// With the inertia of the pose; of a lever that slides also with what its turning and sliding do to each other.
void StateObserver::step_general(const Reading& reading, const std::array<bool, kMaxAxes>& counted,
                                 double dt, std::span<Axis> axes) EBAC_RT {
  const Axes q = of_all(axes, &Axis::joint, &Joint::q);
  const Axes dq = slides_ ? of_all(axes, &Axis::joint, &Joint::dq) : Axes::Zero();
  const Pose here = pose(kinematics_, q, dq);
  Axes along = here.j.transpose() * of_all(axes, &Axis::port, &Port::f_meas);
  if (slides_) along -= handle_mass_ * here.coriolis;
  Axes now = Axes::Zero(), speed = Axes::Zero(), then = Axes::Zero(), speed_then = Axes::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto e = static_cast<Eigen::Index>(i);
    observer_[i].set_mass_share(mass_share(here, e));
    const AxisObserver& observer =
        follow(i, axes[i].joint, along[e] / travel_[e], reading, counted[i], dt);
    now[e] = observer.x() / travel_[e];
    speed[e] = observer.v() / travel_[e];
    observer.predict(then[e], speed_then[e]);
    then[e] /= travel_[e];
    speed_then[e] /= travel_[e];
  }
  const Axes x = forward(kinematics_, now);
  const Axes v = jacobian(kinematics_, now) * speed;
  const Axes x_act = forward(kinematics_, then);
  const Axes v_act = jacobian(kinematics_, then) * speed_then;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto e = static_cast<Eigen::Index>(i);
    Estimate& est = axes[i].port.est;
    est.dx = dt > 0 ? x[e] - est.x : 0.0;
    est.x = x[e];
    est.v = v[e];
    est.x_act = x_act[e];
    est.v_act = v_act[e];
    enter(i, axes[i].port);
  }
}

void StateObserver::step(const Reading& reading, const std::array<bool, kMaxAxes>& counted,
                         double dt, std::span<Axis> axes) EBAC_RT {
  trust(reading, dt, axes.size());
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
      observer.predict(est.x_act, est.v_act);
      enter(i, port);
    }
  } else {
    step_general(reading, counted, dt, axes);
  }
}

}  // namespace ebac
