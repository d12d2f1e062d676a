#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "ebac/control/commands_in_flight.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/loop/force_history.hpp"
#include "ebac/loop/force_trend.hpp"
#include "ebac/loop/gain_schedule.hpp"
#include "ebac/loop/held_device.hpp"
#include "ebac/loop/motor_echo.hpp"
#include "ebac/loop/motor_force.hpp"
#include "ebac/loop/motor_strength.hpp"
#include "ebac/loop/observer_gains.hpp"
#include "ebac/loop/observer_params.hpp"
#include "ebac/loop/proven_velocity.hpp"
#include "ebac/loop/sensor_noise.hpp"

namespace ebac {

/// State of one axis from encoder, force sensor and current: where the device is within an encoder
/// count, how fast it moves without lag, and both for the instant at which the next command acts.
///
/// The device obeys M v' = F_h - b v - r - f + D, with the force of the hand F_h, Coulomb friction r,
/// the motor's force f behind its current loop, and a slow disturbance D: the declared weight, and what
/// is not declared (bias of the sensor, more friction). The sensor shows F_M = G F_h with G =
/// 1/(force_lag s + 1). Passed through G, the equation holds for what is measured, but for r, which is
/// taken to be that of u:
///
///   M u' = F_M + D - b u - r - G f,    u = G v,    v = u + force_lag u'
///
/// so the lag costs no noise. Friction takes what would stop the device within the tick, and at most
/// the friction there is: a device that is held rests in the estimate, too, as in the time stepping of
/// Moreau. A force that is old when it is read, as one that came over a network,
/// is behind G by its age as well: its mean age joins force_lag, and a reading older or newer than
/// that is moved to it along the line through the last two records.
///
/// The encoder corrects x, u and D with the gains of `GainSchedule`. x is kept within 1.5 counts of the reading, and v
/// within what two readings prove of it (`ProvenVelocity`). Where the reading stands while x is at the end of its
/// counts, the device is held, and D learns by what in 2 ms (`HeldDevice`).
///
/// The prediction takes the force of the hand to change as it did in the last 12 ms, and at rest without
/// the noise it shows: a lag in that force of 1 N would be 4 m/s^2.
///
/// With `learn_scale`, f counts as its learned `MotorStrength` times the command.
class AxisObserver {
 public:
  struct Motion {
    double x = 0;  // m
    double v = 0;  // m/s
  };

  AxisObserver(const ObserverParams& params, double mass_share = 1) EBAC_RT
      : params_(params),
        mass_(params.mass* mass_share),
        per_mass_(1 / mass_),
        gains_(params),
        held_(params.friction),
        proven_(params.count),
        motor_(params.current_lag),
        strength_(params.count),
        noise_(params.force_noise),
        in_flight_(params.delay) {}

  /// At rest at `x` [m], with the hand's `force` [N] if it is more than noise. What else has held the device lets go
  /// now; seen through G, it fades.
  void start(double x, double force) EBAC_RT {
    noise_ = SensorNoise(params_.force_noise);
    const double held = noise_.exceeded_by(std::abs(force)) ? force : 0;
    x_ = x;
    proven_.start(x);
    held_.restart();
    gains_.restart();
    u_ = v_ = 0;
    disturbance_ = weight_;
    motor_ = MotorForce(params_.current_lag, held + weight_);
    echo_.restart(motor_.shown());
    measured_ = before_last_ = held;
    trend_ = ForceTrend(held);
    old_ = false;
    in_flight_ = CommandsInFlight(params_.delay);
    records_ = {};
    dt_ = 0;
  }

  /// The mass felt on this axis, as a share of that of the parameters (a gimbal's first axis).
  void set_mass_share(double share) EBAC_RT {
    mass_ = params_.mass * share;
    per_mass_ = 1 / mass_;
  }

  /// Whether the motor pushes, as on a world or to carry a weight.
  bool pushes() const EBAC_RT { return strength_.pushes(); }

  /// Whether the strength of the motor is learned now.
  void set_learns(bool learns) EBAC_RT { learns_ = learns; }

  /// The part of D that is known: the weight of the device along this axis [N].
  void set_weight(double weight) EBAC_RT {
    disturbance_ += weight - weight_;
    undoubted_ += weight - weight_;
    weight_ = weight;
  }

  /// Takes one tick: the encoder [m], if it was read anew, the force sensor [N], and the force that
  /// acted over the last interval [N].
  void step(const std::optional<Aged>& encoder, const Aged& seen, double applied,
            double dt) EBAC_RT {
    const double measured = records_.at_mean_age(seen, dt, params_.force_age);
    if (dt != dt_ || records_.started()) set_tick(dt);
    doubt(seen.age > params_.force_age, measured);
    const double motor = motor_.hold(strength_.of(applied));  // G f
    double force = mean_of_readings(measured, measured_, before_last_) + disturbance_;
    if (echo_.heard()) force += echo_.missed(motor_.shown(), motor);
    const double bend = measured - 2 * measured_ + before_last_;
    noise_.hear(std::abs(bend));
    before_last_ = measured_;
    measured_ = measured;
    trend_.follow(measured, noise_.deviation());
    const double pull = slowed(force - damping_ * u_ - motor, u_, dt);
    const double a = pull * per_mass_;
    const double before = x_;
    x_ += (u_ + (0.5 * dt + motor_.sensor_lag()) * a) * dt;
    u_ += a * dt;
    proven_.pass(dt);
    const double reading = encoder ? encoder->value + v_ * encoder->age : proven_.reading();
    if (encoder) {
      correct(reading);
      keep_place(reading, pull);
    }
    moved_ = x_ - before;
    v_ = u_ + motor_.sensor_lag() * acceleration();
    if (encoder) keep_pace(reading);
  }

  /// The command of the last tick, as force at the handle, joins those in flight.
  void give(double force) EBAC_RT {
    if (params_.learn_scale) strength_.give(force);
    in_flight_.push(strength_.of(force));
  }

  /// Where the device is when a command given now acts, in the middle of its interval: over every
  /// command in flight, half a tick and the current lag, the hand's force changing as it does.
  Motion predict() const EBAC_RT {
    double x = x_, v = v_;
    LaggedForce motor = motor_.acts();
    const double calm = trend_.level();
    const double hand = calm + gains_.moving() * (measured_ - calm) + disturbance_;
    double ahead = params_.force_lag;
    const auto advance = [&](double force, double time) EBAC_RT {
      const double grown = trend_.trend() * (ahead + 0.5 * time);
      const double a = slowed(hand + grown - damping_ * v - force, v, time) * per_mass_;
      x += (v + 0.5 * a * time) * time;
      v += a * time;
      ahead += time;
    };
    for (int j = 0; j < in_flight_.size(); ++j) {
      advance(motor.hold(in_flight_[j]), dt_);
    }
    advance(motor.force(), 0.5 * dt_ + params_.current_lag);
    return {x, v};
  }

  double x() const EBAC_RT { return x_; }
  double moved() const EBAC_RT { return moved_; }  // m, in the last interval
  double v() const EBAC_RT { return v_; }
  double disturbance() const EBAC_RT { return disturbance_; }

  /// Share of the last 0.1 s in which the measured force bent more than its declared noise does.
  double rough() const EBAC_RT { return noise_.rough(); }

  /// Share of the last 50 ms in which the readings contradicted the model.
  double contradicted() const EBAC_RT { return gains_.contradicted(); }

 private:
  static constexpr double kCell = 1.5;  // counts from the reading that x may have

  double acceleration() const EBAC_RT {
    const double pull = measured_ + disturbance_ - damping_ * u_ - motor_.shown();
    return slowed(pull, u_, dt_) * per_mass_;
  }

  /// What friction leaves of `pull` [N] at a velocity, over a time.
  double slowed(double pull, double v, double time) const EBAC_RT {
    if (!(params_.friction > 0 && time > 0)) return pull;
    const double stopping = pull + mass_ * v / time;
    return pull - std::clamp(stopping, -params_.friction, params_.friction);
  }

  /// While the force is old, the encoder counts in full and D holds what the force has changed by.
  /// With the first force after that, D is what it was before.
  void doubt(bool old, double measured) EBAC_RT {
    if (old && !old_) undoubted_ = disturbance_;
    if (old) noise_.doubt();
    if (old_ && !old) {
      disturbance_ = undoubted_;
      measured_ = before_last_ = measured;
      trend_.begin(measured);
    }
    old_ = old;
  }

  void correct(double reading) EBAC_RT {
    const double off = reading - x_;
    if (learns_ && !old_) {
      strength_.learn(std::clamp(off, -params_.count, params_.count), v_, dt_);
    }
    const ObserverGains more = gains_.correct(off, u_, noise_);
    x_ += more.x;
    u_ += more.v;
    disturbance_ += more.d * mass_;
  }

  /// Keeps x by the reading. Of a device that is held the model stops, and D takes the `pull` [N] that would move it.
  void keep_place(double reading, double pull) EBAC_RT {
    const double room = kCell * params_.count;
    const double beyond = x_ - std::clamp(x_, reading - room, reading + room);
    x_ -= beyond;
    const bool stood = std::abs(reading - proven_.reading()) < 0.5 * params_.count;
    held_.take(stood, beyond, proven_.unread());
    if (!held_.held(beyond * u_)) return;
    if (pull * u_ > 0) disturbance_ -= held_.taking() * pull;
    u_ = 0;
  }

  /// Keeps v by what the readings prove of it.
  void keep_pace(double reading) EBAC_RT {
    const double off = proven_.take(reading, v_);
    if (!proven_.refuted()) return;
    gains_.contradict();
    u_ -= off;
    v_ -= off;
  }

  void set_tick(double dt) EBAC_RT;

  ObserverParams params_;
  ForceHistory records_;
  double mass_;         // kg
  double per_mass_;     // 1/kg
  double damping_ = 0;  // N s/m
  GainSchedule gains_;
  HeldDevice held_;
  ProvenVelocity proven_;
  MotorForce motor_;
  MotorEcho echo_;
  MotorStrength strength_;
  SensorNoise noise_;
  ForceTrend trend_;
  CommandsInFlight in_flight_;
  double x_ = 0;            // m
  double moved_ = 0;        // m
  double u_ = 0;            // m/s, the velocity behind the sensor's lag
  double v_ = 0;            // m/s
  double disturbance_ = 0;  // N
  double weight_ = 0;       // N, of the device, in it
  bool learns_ = false;
  double measured_ = 0;     // N
  double before_last_ = 0;  // N, the reading before
  double dt_ = 0;           // s, argument of the last set_tick
  double undoubted_ = 0;    // N, the disturbance when the force began to be old
  bool old_ = false;        // the force
};

}  // namespace ebac
