#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "ebac/control/commands_in_flight.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/loop/force_history.hpp"
#include "ebac/loop/force_trend.hpp"
#include "ebac/loop/motor_echo.hpp"
#include "ebac/loop/motor_force.hpp"
#include "ebac/loop/motor_strength.hpp"
#include "ebac/loop/observer_gains.hpp"
#include "ebac/loop/observer_params.hpp"
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
/// The encoder corrects x, u and D. A reading says little about where in its count the device is, so
/// an innovation counts half up to one count and whole beyond, and x is kept within 1.5 counts of the
/// reading. Where the sensor shows less noise than declared, the half shrinks with it, down to a tenth,
/// at rest: the reading changes with the swing of a hand within a count, and would keep it going. In
/// motion it does not: an error of the model by a millinewton would take x through the whole count, and
/// a hand that swings slowly would draw 0.4 mW. The steady Kalman gain of force noise against a reading
/// uniform within a count has the bandwidth w = sqrt(sqrt(12) force_noise / (M count)). 0.4 of it is
/// used in motion, 0.3 at rest, where an edge of a count would be felt as a click; D is slower than x
/// and u, by far so at rest. All of w is used where the force turns out to be noisier than declared, and
/// where the readings go on contradicting the model: friction that holds the device is a force that D
/// must learn, or x would rest at the end of its counts, with a velocity that is none. Where the reading stands
/// for 10 ms while x is at that end, D learns it in 2 ms.
///
/// The prediction takes the force of the hand to change as it did in the last 12 ms, and at rest without
/// the noise it shows: a lag in that force of 1 N would be 4 m/s^2. v is kept within what two readings
/// prove of it.
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
        leaning_(kLeans* std::max(0.0, 1 - params.friction / kSticks)),
        motor_(params.current_lag),
        strength_(params.count),
        noise_(params.force_noise),
        in_flight_(params.delay) {}

  /// At rest at `x` [m], with the hand's `force` [N] if it is more than noise. What else has held the device lets go
  /// now; seen through G, it fades.
  void start(double x, double force) EBAC_RT {
    noise_ = SensorNoise(params_.force_noise);
    const double held = noise_.exceeded_by(std::abs(force)) ? force : 0;
    x_ = reading_ = x;
    pace_ = unread_ = stands_ = leans_ = astray_ = 0;
    u_ = v_ = 0;
    disturbance_ = weight_;
    motor_ = MotorForce(params_.current_lag, held + weight_);
    echo_.restart(motor_.shown());
    measured_ = before_last_ = held;
    trend_ = ForceTrend(held);
    contradicted_ = 0;
    moving_ = 1;
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
    unread_ += dt;
    const double reading = encoder ? encoder->value + v_ * encoder->age : reading_;
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
    const double hand = calm + moving_ * (measured_ - calm) + disturbance_;
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

  /// Share of the last 50 ms in which the reading was more than 1.5 counts from where the model put it.
  double contradicted() const EBAC_RT { return contradicted_; }

 private:
  // Found by random search on 72 hands in 25 cells of delay, stiffness and error of the facts: force
  // ripple, hands at rest and energy given out.
  static constexpr double kCell = 1.5;  // counts from the reading that x may have
  static constexpr double kDithered =
      0.09;                                // 1, (w dt)^2 from which noise moves x over whole counts
  static constexpr double kStands = 0.01;  // s, so long stands the reading of a held device
  static constexpr double kLeans = 1.5e-3;  // s, so long the model would leave it on one side
  static constexpr double kSticks = 0.5;    // N, friction with which it need not
  static constexpr double kHolds = 2e-3;    // s, in which D takes what would move it
  static constexpr double kMoving = 0.01;   // m/s, from here on the device moves
  static constexpr double kSlow = 2.5e-3;   // m/s, from here on a quiet sensor counts as any other
  static constexpr double kQuiet = 0.5;     // of the declared noise: less is a quiet sensor
  static constexpr double kRests = 0.05;    // s, until it counts as resting
  static constexpr double kLeast = 0.2;     // of the share within a count, without noise
  static constexpr double kMemory = 0.05;   // s, of the contradictions
  static constexpr double kBears = 0.15;    // share of ticks that may contradict
  static constexpr double kLearn = 2;       // from here to 1/2 more, all gains rise to those of w
  static constexpr double kPatience = 3.5e-3;  // s, half a period of a cable's resonance of 140 Hz

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
    const double count = params_.count;
    const double off = reading - x_;
    const double within = std::clamp(off, -count, count);
    if (learns_ && !old_) strength_.learn(within, v_, dt_);
    const double noisy = std::clamp(2.5 * noise_.rough() - 0.5, 0.0, 1.0);
    contradicted_ += ((std::abs(off) > 1.5 * count ? 1.0 : 0.0) - contradicted_) * forget_;
    moving_ = std::max(std::min(1.0, std::abs(u_) * (1 / kMoving)), moving_ * resting_);
    double share = noise_.deviation() * per_noise_;
    if (share < kQuiet)
      share = std::max(share, std::clamp(moving_ * (kMoving / kSlow), kLeast, 1.0));
    share *= within_;
    const double innovation = off - (1 - noisy) * (1 - share) * within;
    ObserverGains gain = at_rest_.towards(in_motion_, moving_);
    const double wrong = std::max(noisy, std::min(1.0, kLearn * (contradicted_ - kBears)));
    if (wrong > 0) gain = gain.towards(full_, wrong);
    x_ += gain.x * innovation;
    u_ += gain.v * innovation;
    disturbance_ += gain.d * innovation * mass_;
  }

  /// Keeps x by the reading. A device whose reading stands while the model would `pull` it on [N] is held, as by more
  /// friction than is known: the model stops, and D takes the pull. A hand that shakes within a count turns sooner
  /// than the model leans out of the reading; the more friction there is, the likelier a device is held.
  void keep_place(double reading, double pull) EBAC_RT {
    const double room = kCell * params_.count;
    const double beyond = x_ - std::clamp(x_, reading - room, reading + room);
    x_ -= beyond;
    stands_ = std::abs(reading - reading_) < 0.5 * params_.count ? stands_ + unread_ : 0;
    if (beyond * leans_ <= 0) leans_ = 0;
    if (beyond != 0) leans_ += std::copysign(unread_, beyond);
    if (stands_ < kStands || beyond * u_ <= 0 || std::abs(leans_) < leaning_) return;
    if (pull * u_ > 0) disturbance_ -= holding_ * pull;
    u_ = 0;
  }

  /// Two readings prove the mean velocity between them within a count; now, it may be off by half of
  /// what it changes by, each to a count. A force that is wrong by far does not lead beyond that for
  /// longer than `kPatience`. Where motor and handle ring on a cable, the sign alternates sooner.
  void keep_pace(double reading) EBAC_RT {
    const double per_time = unread_ == dt_ ? per_dt_ : 1 / unread_;
    const double pace = (reading - reading_) * per_time;
    const double unsure = 2 * params_.count * per_time + 0.5 * std::abs(pace - pace_);
    const double off = v_ - std::clamp(v_, pace - unsure, pace + unsure);
    const double less = std::copysign(std::max(0.0, std::abs(astray_) - unread_), astray_);
    astray_ = off == 0 ? less : (off * astray_ < 0 ? 0.0 : astray_) + std::copysign(unread_, off);
    if (std::abs(astray_) > kPatience) {
      contradicted_ += (1 - contradicted_) * forget_;
      u_ -= off;
      v_ -= off;
    }
    reading_ = reading;
    pace_ = pace;
    unread_ = 0;
  }

  void set_tick(double dt) EBAC_RT;

  ObserverParams params_;
  ForceHistory records_;
  double mass_;         // kg
  double per_mass_;     // 1/kg
  double damping_ = 0;  // N s/m
  double leaning_;      // s
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
  double contradicted_ = 0;
  double reading_ = 0;  // m, the last one
  double pace_ = 0;     // m/s, mean velocity between the last two
  double unread_ = 0;   // s, since the last one
  double leans_ = 0;    // s, for which x would leave the reading, with the sign of the side
  double stands_ = 0;   // s, for which the reading has not changed
  double astray_ = 0;   // s, that v was beyond what the readings prove, with the sign of its error
  double dt_ = 0;       // s, argument of the last set_tick
  double per_dt_ = 0;   // 1/s
  double undoubted_ = 0;  // N, the disturbance when the force began to be old
  bool old_ = false;      // the force
  double moving_ = 1;     // 1 in motion, 0 at rest
  ObserverGains in_motion_{}, at_rest_{}, full_{};
  double within_ = 1;     // share of an innovation within a count
  double per_noise_ = 1;  // 1/N, of the declared noise
  double resting_ = 0;    // share kept per tick
  double holding_ = 0;    // share taken per tick
  double forget_ = 0;
};

}  // namespace ebac
