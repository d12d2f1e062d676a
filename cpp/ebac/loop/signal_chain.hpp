#pragma once

#include <algorithm>
#include <span>

#include "ebac/core/device.hpp"
#include "ebac/core/timing.hpp"
#include "ebac/loop/compensation_in_flight.hpp"
#include "ebac/loop/energy_account.hpp"
#include "ebac/loop/state_observer.hpp"
#include "ebac/model/device.hpp"
#include "ebac/model/environment.hpp"
#include "ebac/model/of_all.hpp"

namespace ebac {

/// The control side of one device: the parts that turn counts into ports and forces into currents,
/// with their memory. Its functions are the stages of `tick`, in order.
class SignalChain {
 public:
  /// `timing` has the delay after which a command acts.
  SignalChain(const DeviceModel& device, const Environment& environment, const Timing& timing,
              const Observing& observing = {});

  /// Another virtual world, from this tick on. An external one is used as it is; the poster keeps it, so that none is
  /// freed here.
  void change(const Environment& environment) EBAC_RT;

  /// Whether the law of now on uses the observer's estimate.
  void act(bool observed) EBAC_RT { observer_.act(observed); }

  /// A law whose account is `drained` at rest gives the observer up, until the hand moves.
  void heed(bool drained, double dt, std::span<const Axis> axes) EBAC_RT {
    if (observer_.on()) observer_.heed(drained, dt, axes);
  }

  /// Velocity, acceleration and the observer begin anew.
  void forget() EBAC_RT {
    velocity_ = {};
    speed_ = acceleration_ = {};
    observer_.forget();
  }

  /// counts -> q, dq
  void measure(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT;

  /// q, dq, applied current -> x, dx, v, f_applied, f_meas
  void forward(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT;

  /// counts, f_meas, currents -> est: the state now and when the command of this tick acts
  void observe(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT {
    if (observer_.on()) observer_.step(reading, counted_, dt, axes);
  }

  /// f_applied, dx -> work, unsure, damped: the energy account, whatever the law
  void account(std::span<Axis> axes) EBAC_RT { account_.take(axes, given_back_, observer_.on()); }

  /// Shows the law the applied force without the static compensation in it, which is no doing of the law: the work that
  /// carries weight comes back, and what is given back of friction and inertia the device itself takes.
  void show_own_force(std::span<Axis> axes) EBAC_RT {
    if (compensates_) put_own_force(axes);
  }
  void show_whole_force(std::span<Axis> axes) EBAC_RT {
    if (compensates_) put_whole_force(axes);
  }

  /// x, v at time t -> f_env, world_v
  ContactForce contact(double t, std::span<Axis> axes) const EBAC_RT;

  /// f_cmd -> tau -> current: transpose, static compensation of eq. (2), the drive's peak
  void drive(double dt, std::span<Axis> axes) EBAC_RT;

  /// The gain of a soft start or stop with which these currents are sent, if not whole; 0 where they are not.
  void sent_with(double gain) EBAC_RT {
    if (compensates_) compensation_in_flight_.sent_with(gain);
  }

 private:
  /// Values that depend on the time since the last tick alone.
  void set_tick(double dt) EBAC_RT {
    dt_ = dt;
    account_.set_tick(dt);
  }
  static void enter(Port& port, double dt, double x, double v, double f_applied) EBAC_RT {
    port.dx = dt > 0 ? x - port.x : 0.0;
    port.x = x;
    port.v = v;
    port.dt = dt;
    port.f_applied = f_applied;
  }
  ContactForce meet(const Axes& x, const Axes& v, double t) const EBAC_RT;
  ContactForce meet_in_space(const External& world, const Axes& x, const Axes& v,
                             double t) const EBAC_RT;
  void forward_general(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT;
  Axes compensation_that_acted(const Axes& q) EBAC_RT;
  void drive_general(double dt, std::span<Axis> axes) EBAC_RT;
  void put_own_force(std::span<Axis> axes) EBAC_RT;
  void put_whole_force(std::span<Axis> axes) EBAC_RT;
  Axes weight_at(const Axes& q) const EBAC_RT;
  void send(Joint& joint, double tau) const EBAC_RT;
  Axes compensate_motion(double dt, std::span<const Axis> axes) EBAC_RT;

  Kinematics kinematics_;
  Encoder encoder_;
  Velocity estimator_;
  Compensation compensation_;
  Environment first_;  // kept to the end: another world frees nothing in a tick
  Environment environment_;
  StateObserver observer_;
  EnergyAccount account_;
  double rad_per_count_;   // joint
  double radius_;          // m
  Axes travel_;            // m, of each axis per joint angle
  double torque_per_amp_;  // N m/A, at the joint
  double amp_per_torque_;  // A/(N m)
  double force_per_amp_;   // N/A, at the handle of a linear device
  double peak_current_;    // A
  double carried_weight_;  // N
  double dt_ = 0;          // s, since the last tick; 0 in the first
  bool linear_;
  bool compensates_;
  CompensationInFlight compensation_in_flight_;
  std::array<double, kMaxAxes> given_back_{};  // N, static compensation in the applied force
  std::array<double, kMaxAxes> whole_{};       // N, applied forces while the law is shown its own
  std::array<VelocityState, kMaxAxes> velocity_{};
  std::array<double, kMaxAxes> counts_age_{};    // s, of the last reading
  std::array<bool, kMaxAxes> counted_{};         // whether new counts came
  std::array<double, kMaxAxes> speed_{};         // m/s, at the handle
  std::array<double, kMaxAxes> acceleration_{};  // m/s^2, filtered
};

// Inline, as every line of a tick of the usual device and world; signal_chain.cpp has the others.

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

inline void SignalChain::forward(const Reading& reading, double dt, std::span<Axis> axes) EBAC_RT {
  if (linear_ && !compensates_) {  // the general case below, with J = R
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

inline ContactForce SignalChain::meet(const Axes& x, const Axes& v, double t) const EBAC_RT {
  const auto* external = std::get_if<External>(&environment_);
  return external == nullptr ? ebac::contact(environment_, x, v, t)
                             : meet_in_space(*external, x, v, t);
}

inline ContactForce SignalChain::contact(double t, std::span<Axis> axes) const EBAC_RT {
  Axes x = of_all(axes, &Axis::port, &Port::x);
  Axes v = of_all(axes, &Axis::port, &Port::v);
  if (const double weight = observer_.weight(); weight > 0) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const auto e = static_cast<Eigen::Index>(i);
      const Estimate& est = axes[i].port.est;
      x[e] += weight * (est.x_act - x[e]);
      v[e] += weight * (est.v_act - v[e]);
    }
    t += weight * observer_.ahead(dt_);
  }
  ContactForce contact = meet(x, v, t);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto e = static_cast<Eigen::Index>(i);
    axes[i].port.f_env = contact.force[e];
    axes[i].port.world_v = contact.velocity[e];
  }
  return contact;
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

}  // namespace ebac
