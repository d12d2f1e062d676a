#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <span>

#include "ebac/core/concepts.hpp"
#include "ebac/loop/axis_observer.hpp"
#include "ebac/loop/observing.hpp"
#include "ebac/model/device.hpp"
#include "ebac/model/environment.hpp"
#include "ebac/model/pose.hpp"

namespace ebac {

/// The control side of one device: the parts that turn counts into ports and forces into currents,
/// with their memory. Its functions are the stages of `tick`, in order.
class SignalChain {
 public:
  SignalChain(const DeviceModel& device, const Environment& environment,
              const Observing& observing = {});

  /// Another virtual world, from this tick on.
  void change(const Environment& environment) EBAC_RT { environment_ = environment; }

  /// Velocity, acceleration and the observer begin anew.
  void forget() EBAC_RT {
    velocity_ = {};
    speed_ = acceleration_ = {};
    forgot_ = true;
  }

  /// counts -> q, dq
  void measure(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT;

  /// q, dq, applied current -> x, dx, v, f_applied, f_meas
  void forward(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT;

  /// counts, f_meas, currents -> est: the state now and when the command of this tick acts
  void observe(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT {
    if (observing_.on) estimate(reading, dt, axes);
  }

  /// f_applied, dx -> work, unsure, damped: the energy account, whatever the law
  void account(std::span<Axis> axes) EBAC_RT {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      Port& port = axes[i].port;
      const double f = port.f_applied;
      const double bound = observing_.on ? port.est.bound : half_count_;
      // By summation by parts: what the last position leaves open, and every change of the force.
      changes_[i] += bound_[i] * std::abs(f - acted_[i]);
      acted_[i] = f;
      bound_[i] = bound;
      port.unsure = changes_[i] + bound * std::abs(f);
      if (observing_.on) {
        port.work += f * port.est.dx;
        port.damped += damping_ * port.dt * port.est.v * port.est.v;
      } else {
        const double sure = std::max(std::abs(port.dx) - 2 * half_count_, 0.0);
        port.work += f * port.dx;
        port.damped += b_ * sure * sure;
      }
    }
  }

  /// x, v at time t -> f_env, world_v
  ContactForce contact(double t, std::span<Axis> axes) const EBAC_RT;

  /// f_cmd -> tau -> current: transpose, static compensation of eq. (2), the drive's peak
  void drive(double dt, std::span<Axis> axes) EBAC_RT;

 private:
  /// Values that depend on the time since the last tick alone.
  void set_tick(double dt) EBAC_RT {
    dt_ = dt;
    b_ = dt > 0 ? damping_ / dt : 0.0;
  }
  static void enter(Port& port, double dt, double x, double v, double f_applied) EBAC_RT {
    port.dx = dt > 0 ? x - port.x : 0.0;
    port.x = x;
    port.v = v;
    port.dt = dt;
    port.f_applied = f_applied;
  }
  template <class Part>
  static Axes all(std::span<const Axis> axes, Part Axis::* part, double Part::* member) EBAC_RT;
  void estimate(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT;
  void trust(const Reading& reading, double dt, std::size_t axes) EBAC_RT;
  void estimate_general(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT;
  std::optional<Aged> encoder(const Reading& reading, std::size_t axis, double x) const EBAC_RT {
    if (!counted_[axis]) return std::nullopt;
    return Aged{x, reading.counts_age[axis]};
  }
  void forward_general(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT;
  void drive_general(double dt, std::span<Axis> axes) EBAC_RT;
  void send(Joint& joint, double tau) const EBAC_RT;
  Axes compensate(double dt, std::span<const Axis> axes) EBAC_RT;

  Kinematics kinematics_;
  Encoder encoder_;
  Velocity estimator_;
  Compensation compensation_;
  Environment environment_;
  Observing observing_;
  std::array<AxisObserver, kMaxAxes> observer_;
  bool forgot_ = false;  // the observer begins in this tick
  double weight_ = 1;    // of the estimate
  Fallback fallback_ = Fallback::kNone;
  double damping_;         // N s/m, lower bound of the device's own damping
  double half_count_;      // m
  double rad_per_count_;   // joint
  double radius_;          // m
  double torque_per_amp_;  // N m/A, at the joint
  double amp_per_torque_;  // A/(N m)
  double force_per_amp_;   // N/A, at the handle of a linear device
  double peak_current_;    // A
  double gravity_;         // m/s^2
  double dt_ = 0;          // s, since the last tick; 0 in the first
  double b_ = 0;           // N/m, B = b/T
  bool linear_;
  bool compensates_;
  std::array<VelocityState, kMaxAxes> velocity_{};
  std::array<double, kMaxAxes> counts_age_{};    // s, of the last reading
  std::array<bool, kMaxAxes> counted_{};         // whether new counts came
  std::array<double, kMaxAxes> speed_{};         // m/s, at the handle
  std::array<double, kMaxAxes> acceleration_{};  // m/s^2, filtered
  std::array<double, kMaxAxes> acted_{};         // N, force of the last interval
  std::array<double, kMaxAxes> bound_{};         // m, error of the last position
  std::array<double, kMaxAxes> changes_{};       // J, of `unsure`, without the present force
};

// Inline: every line of a tick is here or in `tick`.

inline SignalChain::SignalChain(const DeviceModel& device, const Environment& environment,
                                const Observing& observing)
    : kinematics_(device.kinematics),
      encoder_(device.encoder),
      estimator_(device.velocity),
      compensation_(device.compensation),
      environment_(environment),
      observing_(observing),
      observer_{AxisObserver(observing.params), AxisObserver(observing.params),
                AxisObserver(observing.params)},
      damping_(std::max(0.0, device.facts().damping)),
      half_count_(device.facts().count / 2),
      rad_per_count_(device.encoder.count() / device.capstan.ratio()),
      radius_(device.radius()),
      torque_per_amp_(device.motor.torque_constant * device.capstan.ratio()),
      amp_per_torque_(1 / torque_per_amp_),
      force_per_amp_(torque_per_amp_ / radius_),
      peak_current_(device.drive.peak_current(device.motor)),
      gravity_(device.mechanics.gravity),
      linear_(std::holds_alternative<Linear>(device.kinematics)),
      compensates_(device.compensation.active()) {}

inline void SignalChain::measure(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT {
  if (dt != dt_) set_tick(dt);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    Joint& joint = axes[i].joint;
    const double before = joint.q;
    joint.counts = dt > 0 ? encoder_.unwrap(reading.counts[i], joint.counts) : reading.counts[i];
    joint.q = rad_per_count_ * static_cast<double>(joint.counts);
    const double since = dt > 0 ? dt + counts_age_[i] - reading.counts_age[i] : 0.0;
    counts_age_[i] = reading.counts_age[i];
    counted_[i] = since > 0 || dt == 0;
    if (counted_[i]) {  // otherwise the estimate stands
      joint.dq = velocity_[i].update(estimator_, joint.q, joint.q - before, since, rad_per_count_);
    }
    joint.current_applied = reading.current_applied[i];
  }
}

/// One member of every axis, zero for the axes not in use.
template <class Part>
Axes SignalChain::all(std::span<const Axis> axes, Part Axis::* part,
                      double Part::* member) EBAC_RT {
  const auto of = [&](std::size_t i) { return i < axes.size() ? axes[i].*part.*member : 0.0; };
  return {of(0), of(1), of(2)};
}

inline void SignalChain::forward(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT {
  if (linear_) {  // the general case below, with J = R
    for (std::size_t i = 0; i < axes.size(); ++i) {
      Port& port = axes[i].port;
      const Joint& joint = axes[i].joint;
      port.f_meas = reading.force[i];
      enter(port, dt, radius_ * joint.q, radius_ * joint.dq,
            force_per_amp_ * joint.current_applied);
    }
  } else {
    forward_general(reading, dt, axes);
  }
}

inline void SignalChain::forward_general(const Reading& reading, double dt,
                                         std::span<Axis> axes) EBAC_RT {
  const Axes q = all(axes, &Axis::joint, &Joint::q);
  Jacobian j = jacobian(kinematics_, q);
  const Axes x = ebac::forward(kinematics_, q);
  const Axes v = j * all(axes, &Axis::joint, &Joint::dq);
  for (auto i = static_cast<Eigen::Index>(axes.size()); i < kMaxAxes; ++i) j(i, i) = 1;
  const Axes torque = torque_per_amp_ * all(axes, &Axis::joint, &Joint::current_applied);
  const Axes f = j.transpose().inverse() * torque;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto e = static_cast<Eigen::Index>(i);
    axes[i].port.f_meas = reading.force[i];
    enter(axes[i].port, dt, x[e], v[e], f[e]);
  }
}

/// Fades the estimate out in 20 ms where its inputs or its model fail, and in again.
inline void SignalChain::trust(const Reading& reading, double dt, std::size_t axes) EBAC_RT {
  constexpr double kFade = 0.02;  // s
  constexpr double kContradicted = 0.5, kAgrees = 0.1;
  double contradicted = 0;
  for (std::size_t i = 0; i < axes; ++i) {
    contradicted = std::max(contradicted, observer_[i].contradicted());
  }
  const bool model_fails = contradicted > (fallback_ == Fallback::kModel ? kAgrees : kContradicted);
  fallback_ = !observing_.acts                                  ? Fallback::kOff
              : reading.force_status != SensorStatus::kGood     ? Fallback::kForceStatus
              : reading.force_age > observing_.params.force_age ? Fallback::kForceStale
              : model_fails                                     ? Fallback::kModel
                                                                : Fallback::kNone;
  if (fallback_ == Fallback::kOff) {
    weight_ = 0;
  } else if (fallback_ == Fallback::kNone) {
    weight_ = dt > 0 && !forgot_ ? std::min(1.0, weight_ + dt / kFade) : 1.0;
  } else {
    weight_ = std::max(0.0, weight_ - dt / kFade);
    if (fallback_ == Fallback::kForceStale) {
      for (std::size_t i = 0; i < axes; ++i) observer_[i].doubt();
    }
  }
}

inline void SignalChain::estimate(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT {
  trust(reading, dt, axes.size());
  if (forgot_) dt = 0;
  forgot_ = false;
  if (!linear_) return estimate_general(reading, dt, axes);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Joint& joint = axes[i].joint;
    Port& port = axes[i].port;
    AxisObserver& observer = observer_[i];
    if (dt > 0) {
      observer.give(force_per_amp_ * joint.current);
      observer.step(encoder(reading, i, port.x), {port.f_meas, reading.force_age}, port.f_applied,
                    dt);
    } else {
      observer.start(port.x);
    }
    Estimate& est = port.est;
    est.x = observer.x();
    est.dx = dt > 0 ? observer.moved() : 0.0;
    est.v = observer.v();
    observer.predict(est.x_act, est.v_act);
    est.disturbance = observer.disturbance();
    est.bound = observing_.params.count / 2 + std::abs(port.x - est.x);
    est.weight = weight_;
    est.fallback = static_cast<int>(fallback_);
  }
}

/// The same in the joints, where counts and currents are: s = R q, with the inertia of the pose.
inline void SignalChain::estimate_general(const Reading& reading, double dt,
                                          std::span<Axis> axes) EBAC_RT {
  const Axes q = all(axes, &Axis::joint, &Joint::q);
  const Pose here = pose(kinematics_, q, Axes::Zero());
  Axes measured = Axes::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i)
    measured[static_cast<Eigen::Index>(i)] = axes[i].port.f_meas;
  const Axes along = here.j.transpose() * measured / radius_;
  Axes now = Axes::Zero(), speed = Axes::Zero(), then = Axes::Zero(), speed_then = Axes::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto e = static_cast<Eigen::Index>(i);
    const Joint& joint = axes[i].joint;
    AxisObserver& observer = observer_[i];
    observer.set_mass_share(here.inertia[e] / (radius_ * radius_));
    if (dt > 0) {
      observer.give(force_per_amp_ * joint.current);
      observer.step(encoder(reading, i, radius_ * joint.q), {along[e], reading.force_age},
                    force_per_amp_ * joint.current_applied, dt);
    } else {
      observer.start(radius_ * joint.q);
    }
    now[e] = observer.x() / radius_;
    speed[e] = observer.v() / radius_;
    observer.predict(then[e], speed_then[e]);
    then[e] /= radius_;
    speed_then[e] /= radius_;
  }
  const Axes x = ebac::forward(kinematics_, now);
  const Axes v = jacobian(kinematics_, now) * speed;
  const Axes x_act = ebac::forward(kinematics_, then);
  const Axes v_act = jacobian(kinematics_, then) * speed_then;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto e = static_cast<Eigen::Index>(i);
    Port& port = axes[i].port;
    Estimate& est = port.est;
    est.dx = dt > 0 ? x[e] - est.x : 0.0;
    est.x = x[e];
    est.v = v[e];
    est.x_act = x_act[e];
    est.v_act = v_act[e];
    est.disturbance = observer_[i].disturbance();
    est.bound = observing_.params.count / 2 + std::abs(port.x - est.x);
    est.weight = weight_;
    est.fallback = static_cast<int>(fallback_);
  }
}

inline ContactForce SignalChain::contact(double t, std::span<Axis> axes) const EBAC_RT {
  Axes x = all(axes, &Axis::port, &Port::x);
  Axes v = all(axes, &Axis::port, &Port::v);
  if (observing_.acts && weight_ > 0) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const auto e = static_cast<Eigen::Index>(i);
      const Estimate& est = axes[i].port.est;
      x[e] += weight_ * (est.x_act - x[e]);
      v[e] += weight_ * (est.v_act - v[e]);
    }
    t += weight_ * ((observing_.params.delay + 0.5) * dt_ + observing_.params.current_lag);
  }
  ContactForce contact = ebac::contact(environment_, x, v, t);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto e = static_cast<Eigen::Index>(i);
    axes[i].port.f_env = contact.force[e];
    axes[i].port.world_v = contact.velocity[e];
  }
  return contact;
}
/// tau_static of eq. (2).
inline Axes SignalChain::compensate(double dt, std::span<const Axis> axes) EBAC_RT {
  Axes tau = weight(kinematics_, all(axes, &Axis::joint, &Joint::q),
                    compensation_.gravity_mass * gravity_);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double v = radius_ * axes[i].joint.dq;
    if (dt > 0) {
      acceleration_[i] +=
          ((v - speed_[i]) / dt - acceleration_[i]) * dt / (compensation_.inertia_lag + dt);
    }
    speed_[i] = v;
    tau[static_cast<Eigen::Index>(i)] += radius_ * compensation_.force(v, acceleration_[i]);
  }
  return tau;
}

/// The current that gives one axis its torque, up to the drive's peak.
inline void SignalChain::send(Joint& joint, double tau) const EBAC_RT {
  joint.tau = tau;
  joint.current = std::clamp(tau * amp_per_torque_, -peak_current_, peak_current_);
}

inline void SignalChain::drive(double dt, std::span<Axis> axes) EBAC_RT {
  if (linear_ && !compensates_) {  // the general case below, with J = R
    for (Axis& axis : axes) send(axis.joint, radius_ * axis.port.f_cmd);
  } else {
    drive_general(dt, axes);
  }
}

inline void SignalChain::drive_general(double dt, std::span<Axis> axes) EBAC_RT {
  const Axes q = all(axes, &Axis::joint, &Joint::q);
  Axes tau = transpose(kinematics_, q, all(axes, &Axis::port, &Port::f_cmd));
  if (compensates_) tau += compensate(dt, axes);
  for (std::size_t i = 0; i < axes.size(); ++i)
    send(axes[i].joint, tau[static_cast<Eigen::Index>(i)]);
}

}  // namespace ebac
