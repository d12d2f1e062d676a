#include "ebac/loop/signal_chain.hpp"

#include <Eigen/LU>

#include "ebac/model/port_space.hpp"

namespace ebac {

SignalChain::SignalChain(const DeviceModel& device, const Environment& environment,
                         const Timing& timing, const Observing& observing)
    : kinematics_(device.kinematics),
      encoder_(device.encoder),
      estimator_(device.velocity),
      compensation_(device.compensation),
      first_(fresh(environment)),
      environment_(first_),
      observer_(device, observing),
      account_(device.facts()),
      rad_per_count_(device.encoder.count() / device.capstan.ratio()),
      radius_(device.radius()),
      travel_(travel(device.kinematics)),
      torque_per_amp_(device.motor.torque_constant * device.capstan.ratio()),
      amp_per_torque_(1 / torque_per_amp_),
      force_per_amp_(torque_per_amp_ / radius_),
      peak_current_(device.drive.peak_current(device.motor)),
      carried_weight_(device.compensation.gravity_mass * device.mechanics.gravity),
      linear_(std::holds_alternative<Linear>(device.kinematics)),
      compensates_(device.compensation.active()),
      compensation_in_flight_(timing.delay) {}

void SignalChain::change(const Environment& environment) EBAC_RT { environment_ = environment; }

void SignalChain::forward_general(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT {
  const Axes q = of_all(axes, &Axis::joint, &Joint::q);
  Jacobian j = jacobian(kinematics_, q);
  const Axes x = ebac::forward(kinematics_, q);
  const Axes v = j * of_all(axes, &Axis::joint, &Joint::dq);
  for (auto i = static_cast<Eigen::Index>(axes.size()); i < kMaxAxes; ++i) j(i, i) = 1;
  const Axes torque = torque_per_amp_ * of_all(axes, &Axis::joint, &Joint::current_applied);
  const Jacobian to_handle = j.transpose().inverse();
  const Axes f = to_handle * torque;
  const Axes given_back =
      compensates_ ? Axes(to_handle * compensation_that_acted(q)) : Axes::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto e = static_cast<Eigen::Index>(i);
    axes[i].port.f_meas = reading.force[i];
    given_back_[i] = given_back[e];
    enter(axes[i].port, dt, x[e], v[e], f[e]);
  }
}

ContactForce SignalChain::meet_in_space(const External& world, const Axes& x, const Axes& v,
                                        double t) const EBAC_RT {
  const PortSpace space(kinematics_, x);
  return space.felt(world.contact(space.at(), space.velocity(v), t));
}

/// Torque of the static compensation over the last interval.
Axes SignalChain::compensation_that_acted(const Axes& q) EBAC_RT {
  compensation_in_flight_.advance();
  return compensation_in_flight_.motion() + compensation_in_flight_.gain() * weight_at(q);
}

/// Torque that carries the compensated weight.
Axes SignalChain::weight_at(const Axes& q) const EBAC_RT {
  return weight(kinematics_, q, carried_weight_);
}

void SignalChain::put_own_force(std::span<Axis> axes) EBAC_RT {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    whole_[i] = axes[i].port.f_applied;
    axes[i].port.f_applied -= given_back_[i];
  }
}

void SignalChain::put_whole_force(std::span<Axis> axes) EBAC_RT {
  for (std::size_t i = 0; i < axes.size(); ++i) axes[i].port.f_applied = whole_[i];
}

/// tau_static of eq. (2), but for the weight.
Axes SignalChain::compensate_motion(double dt, std::span<const Axis> axes) EBAC_RT {
  Axes tau = Axes::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto e = static_cast<Eigen::Index>(i);
    const double v = travel_[e] * axes[i].joint.dq;
    if (dt > 0) {
      acceleration_[i] +=
          ((v - speed_[i]) / dt - acceleration_[i]) * dt / (compensation_.inertia_lag + dt);
    }
    speed_[i] = v;
    tau[e] = travel_[e] * compensation_.force(v, acceleration_[i]);
  }
  return tau;
}

void SignalChain::drive_general(double dt, std::span<Axis> axes) EBAC_RT {
  const Axes q = of_all(axes, &Axis::joint, &Joint::q);
  Axes tau = transpose(kinematics_, q, of_all(axes, &Axis::port, &Port::f_cmd));
  if (compensates_) {
    const Axes motion = compensate_motion(dt, axes);
    compensation_in_flight_.give(motion);
    tau += weight_at(q) + motion;
  }
  for (std::size_t i = 0; i < axes.size(); ++i)
    send(axes[i].joint, tau[static_cast<Eigen::Index>(i)]);
}

}  // namespace ebac
