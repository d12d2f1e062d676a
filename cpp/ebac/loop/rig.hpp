#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <span>

#include "ebac/core/concepts.hpp"
#include "ebac/model/device.hpp"
#include "ebac/model/environment.hpp"

namespace ebac {

/// The control side of one device: the parts that turn counts into ports and forces into currents, with
/// their memory. Its functions are the stages of `tick`, in order.
class Rig {
 public:
  Rig(const DeviceModel& device, const Environment& environment);

  /// counts -> q, dq
  void measure(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT;

  /// q, dq, applied current -> x, dx, v, f_applied, f_meas
  void forward(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT;

  /// f_applied, dx -> work, damped: the energy account, whatever the law
  void account(std::span<Axis> axes) const EBAC_RT {
    for (Axis& axis : axes) {
      Port& port = axis.port;
      if (!(port.dt > 0)) continue;
      port.work += port.f_applied * port.dx;
      port.damped += damping_ / port.dt * port.dx * port.dx;
    }
  }

  /// x, v -> f_env
  void ask(std::span<Axis> axes) const EBAC_RT;

  /// f_cmd -> tau -> current: transpose, static compensation of eq. (2), the drive's peak
  void drive(double dt, std::span<Axis> axes) EBAC_RT;

 private:
  Axes joints(std::span<const Axis> axes, double Joint::*member) const EBAC_RT;
  Axes ports(std::span<const Axis> axes, double Port::*member) const EBAC_RT;
  Axes compensate(double dt, std::span<const Axis> axes) EBAC_RT;

  Kinematics kinematics_;
  Encoder encoder_;
  Velocity estimator_;
  Compensation compensation_;
  Environment environment_;
  double damping_;           // N s/m, lower bound of what the device takes
  double rad_per_count_;     // joint
  double radius_;            // m
  double torque_per_amp_;    // N m/A, at the joint
  double peak_current_;      // A
  double gravity_;           // m/s^2
  bool linear_;
  bool compensates_;
  std::array<VelocityState, kMaxAxes> velocity_{};
  std::array<double, kMaxAxes> speed_{};         // m/s, at the handle
  std::array<double, kMaxAxes> acceleration_{};  // m/s^2, filtered
};

// Inline: every line of a tick is here or in `tick`.

inline Rig::Rig(const DeviceModel& device, const Environment& environment)
    : kinematics_(device.kinematics),
      encoder_(device.encoder),
      estimator_(device.velocity),
      compensation_(device.compensation),
      environment_(environment),
      damping_(std::max(0.0, device.facts().damping)),
      rad_per_count_(device.encoder.count() / device.capstan.ratio()),
      radius_(device.radius()),
      torque_per_amp_(device.motor.torque_constant * device.capstan.ratio()),
      peak_current_(device.drive.peak_current(device.motor)),
      gravity_(device.mechanics.gravity),
      linear_(std::holds_alternative<Linear>(device.kinematics)),
      compensates_(device.compensation.active()) {}

inline void Rig::measure(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    Joint& joint = axes[i].joint;
    const double before = joint.q;
    joint.counts = dt > 0 ? encoder_.unwrap(reading.counts[i], joint.counts) : reading.counts[i];
    joint.q = rad_per_count_ * static_cast<double>(joint.counts);
    joint.dq = velocity_[i].update(estimator_, joint.q, joint.q - before, dt, rad_per_count_);
    joint.current_applied = reading.current_applied[i];
  }
}

inline Axes Rig::joints(std::span<const Axis> axes, double Joint::*member) const EBAC_RT {
  Axes all = Axes::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    all[static_cast<Eigen::Index>(i)] = axes[i].joint.*member;
  }
  return all;
}

inline Axes Rig::ports(std::span<const Axis> axes, double Port::*member) const EBAC_RT {
  Axes all = Axes::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    all[static_cast<Eigen::Index>(i)] = axes[i].port.*member;
  }
  return all;
}

inline void Rig::forward(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT {
  const auto enter = [&](std::size_t i, double x, double v, double f_applied) EBAC_RT {
    Port& port = axes[i].port;
    port.dx = dt > 0 ? x - port.x : 0.0;
    port.x = x;
    port.v = v;
    port.dt = dt;
    port.f_applied = f_applied;
    port.f_meas = reading.force[i];
  };
  if (linear_) {  // the general case below, with J = R
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const Joint& joint = axes[i].joint;
      enter(i, radius_ * joint.q, radius_ * joint.dq, torque_per_amp_ / radius_ * joint.current_applied);
    }
    return;
  }
  const Axes q = joints(axes, &Joint::q);
  Jacobian j = jacobian(kinematics_, q);
  const Axes x = ebac::forward(kinematics_, q);
  const Axes v = j * joints(axes, &Joint::dq);
  for (auto i = static_cast<Eigen::Index>(axes.size()); i < kMaxAxes; ++i) j(i, i) = 1;
  const Axes torque = torque_per_amp_ * joints(axes, &Joint::current_applied);
  const Axes f = j.transpose().inverse() * torque;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto e = static_cast<Eigen::Index>(i);
    enter(i, x[e], v[e], f[e]);
  }
}

inline void Rig::ask(std::span<Axis> axes) const EBAC_RT {
  const Axes f = force(environment_, ports(axes, &Port::x), ports(axes, &Port::v));
  for (std::size_t i = 0; i < axes.size(); ++i) axes[i].port.f_env = f[static_cast<Eigen::Index>(i)];
}

inline Axes Rig::compensate(double dt, std::span<const Axis> axes) EBAC_RT {
  Axes tau = weight(kinematics_, joints(axes, &Joint::q), compensation_.gravity_mass * gravity_);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double v = radius_ * axes[i].joint.dq;
    if (dt > 0) {
      acceleration_[i] += ((v - speed_[i]) / dt - acceleration_[i]) * dt / (compensation_.inertia_lag + dt);
    }
    speed_[i] = v;
    tau[static_cast<Eigen::Index>(i)] += radius_ * compensation_.force(v, acceleration_[i]);
  }
  return tau;
}

inline void Rig::drive(double dt, std::span<Axis> axes) EBAC_RT {
  const Axes f = ports(axes, &Port::f_cmd);
  Axes tau = linear_ ? Axes(radius_ * f) : transpose(kinematics_, joints(axes, &Joint::q), f);
  if (compensates_) tau += compensate(dt, axes);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    Joint& joint = axes[i].joint;
    joint.tau = tau[static_cast<Eigen::Index>(i)];
    joint.current = std::clamp(joint.tau / torque_per_amp_, -peak_current_, peak_current_);
  }
}

}  // namespace ebac
