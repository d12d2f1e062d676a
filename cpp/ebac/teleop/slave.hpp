#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "ebac/core/check.hpp"
#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/teleop/coupling.hpp"
#include "ebac/teleop/packet.hpp"
#include "ebac/teleop/session.hpp"

namespace ebac::teleop {

/// The slave's one axis, and the spring it meets.
struct SlaveModel {
  double mass = 0.5;               // kg
  double damping = 2;              // N s/m
  double contact = 0.02;           // m
  double contact_stiffness = 500;  // N/m
  double contact_damping = 4;      // N s/m

  static constexpr auto fields() {
    using F = Field<SlaveModel>;
    return std::array{
        F{"mass", &SlaveModel::mass, "kg", "of the slave", 1e-3, 100},
        F{"damping", &SlaveModel::damping, "N s/m", "of its bearing", 0, 1e3},
        F{"contact", &SlaveModel::contact, "m", "where it meets the environment", -1, 1},
        F{"contact_stiffness", &SlaveModel::contact_stiffness, "N/m",
          "of the environment; 0 for free motion", 0, 1e5},
        F{"contact_damping", &SlaveModel::contact_damping, "N s/m",
          "of the environment, on the way in", 0, 1e3},
    };
  }

  double push(double x, double v) const EBAC_RT {
    const double depth = x - contact;
    return depth > 0 ? contact_stiffness * depth +
                           contact_damping * std::max(0.0, v) * (contact_stiffness > 0 ? 1.0 : 0.0)
                     : 0.0;
  }
};

/// Steps of a slave in a tick.
inline constexpr int kSlaveSteps = 10;

/// Returns the model. Throws std::invalid_argument where its motion is too quick for the steps of a tick of `dt` [s]:
/// it would grow without a limit.
inline const SlaveModel& checked_slave(const SlaveModel& model, double dt) {
  check(model, "SlaveModel");
  const double step = dt / kSlaveSteps;
  const double damping = model.damping + model.contact_damping;
  if (damping * step > model.mass) {
    throw std::invalid_argument("SlaveModel.damping + contact_damping = " + shortest(damping) +
                                " N s/m: for a mass of " + shortest(model.mass) +
                                " kg must lie in [0, " + shortest(model.mass / step) +
                                "] N s/m; more mass, or less damping");
  }
  if (model.contact_stiffness * step * step > model.mass) {
    throw std::invalid_argument(
        "SlaveModel.contact_stiffness = " + shortest(model.contact_stiffness) +
        " N/m: for a mass of " + shortest(model.mass) + " kg must lie in [0, " +
        shortest(model.mass / (step * step)) + "] N/m; more mass, or less stiffness");
  }
  return model;
}

/// The slave: where it wants to be by what comes from the master, and its position controller, a spring and a
/// damper between that place and the axis. Its port is (force of that spring, speed of that place).
class SlaveSide {
 public:
  struct State {
    double x = 0;       // m
    double v = 0;       // m/s
    double target = 0;  // m
    double force = 0;   // N
    double met = 0;     // N
    double drift = 0;   // m
  };

  SlaveSide(const SlaveModel& model, const Coupling& coupling, double dt)
      : model_(checked_slave(model, dt)),
        coupling_(checked_coupling(coupling, dt)),
        dt_(dt),
        session_(Role::kSlave, coupling, dt) {
    if (scheme() == Scheme::kWaves) coupling_.damping = coupling_.impedance;  // matched
  }

  /// Whether its sender is to be answered.
  bool take(const Packet& packet) EBAC_RT {
    const bool other = session_.bound() && packet.run != session_.run();
    const Heed heed = session_.judge(packet);
    if (heed == Heed::kBegun) begin();
    if (heed == Heed::kBegun && other) known_ = false;
    if (heed == Heed::kTaken || heed == Heed::kBegun) session_.take(packet);
    return heed != Heed::kRefused;
  }

  /// One tick; returns what to send.
  Packet step(std::int64_t stamp) EBAC_RT {
    session_.tick();
    const Packet in = session_.play();
    const double v = watch().state() == LinkState::kRunning ? follow(in) : 0.0;
    move(v);
    return {.from_slave = true,
            .lost = watch().lost(),
            .session = session_.number(),
            .sequence = session_.next(),
            .echo = receiver().newest(),
            .stamp = stamp,
            .value = coupling_.measured ? state_.met : state_.force,
            .energy = scheme() == Scheme::kWaves ? wave_energy_ : port_.in,
            .wave = wave_sum_,
            .run = session_.run(),
            .scheme = static_cast<std::uint8_t>(coupling_.scheme)};
  }

  const State& state() const EBAC_RT { return state_; }
  const PortEnergy& port() const EBAC_RT { return port_; }
  const LinkWatch& watch() const EBAC_RT { return session_.watch(); }
  const Receiver& receiver() const EBAC_RT { return session_.receiver(); }
  std::uint32_t session() const EBAC_RT { return session_.number(); }
  std::int64_t other_scheme() const EBAC_RT { return session_.other_scheme(); }
  /// Energy given to the controller since the start, sum of force times speed of its target [J].
  double given() const EBAC_RT { return given_; }

 private:
  static constexpr double kAligned = 5e-4;  // m

  Scheme scheme() const EBAC_RT { return static_cast<Scheme>(coupling_.scheme); }

  void begin() EBAC_RT {
    // Passivity control without a reserve would never begin to move; what it may give out goes into the environment.
    port_.begin(scheme() == Scheme::kWaves ? wave_left() : 0.0);
    aligned_ = false;
    if (!(coupling_.realign > 0)) known_ = false;
    last_ = scheme() == Scheme::kWaves ? 0.0 : state_.target;
    smooth_ = 0;
    used_wave_ = used_energy_ = wave_sum_ = wave_energy_ = 0;
  }

  // What the wave that comes in may still carry, before the reserve [J].
  double wave_left() const EBAC_RT { return port_.allowed - port_.debt - used_energy_; }

  // The controller's force at target speed v is f0 + slope v: implicit, exact at the end of the tick.
  double slope() const EBAC_RT { return coupling_.stiffness * dt_ + coupling_.damping; }
  double f0() const EBAC_RT {
    return coupling_.stiffness * (state_.target - state_.x) - coupling_.damping * state_.v;
  }

  /// The speed of the target.
  double follow(const Packet& in) EBAC_RT {
    if (in.sequence > 0 && !known_) {
      zero_ = state_.target - in.value;
      known_ = true;
    }
    const double place = in.sequence > 0 ? zero_ + in.value : state_.target;
    if (!aligned_ && in.sequence > 0) aligned_ = std::abs(place - state_.target) < kAligned;
    if (!aligned_) return align(in, place);
    if (scheme() == Scheme::kWaves) return by_waves(in);
    smooth_ += (place - last_ - smooth_ * dt_) / kSmooth;
    last_ = place;
    const double behind = (place - state_.target) / kSmooth;
    state_.drift = place - state_.target;
    if (scheme() == Scheme::kPositionForce) {
      return std::clamp(behind, -coupling_.fastest, coupling_.fastest);
    }
    double v = smooth_;
    if (coupling_.follow) {
      v += std::clamp(behind - smooth_, -coupling_.catch_up, coupling_.catch_up);
    }
    port_.allowed = std::max(port_.allowed, in.energy);
    return held_to((port_.left() + coupling_.reserve) / dt_, f0(), slope(), v);
  }

  /// Back to the master's place, never beyond it, no faster than `realign` and with no more energy than is allowed.
  double align(const Packet& in, double place) EBAC_RT {
    state_.drift = place - state_.target;
    const double v = std::clamp(state_.drift / kSmooth, -coupling_.realign, coupling_.realign);
    last_ = scheme() == Scheme::kWaves ? in.wave : place;
    if (scheme() == Scheme::kPositionForce) return v;
    if (scheme() == Scheme::kWaves) {
      used_wave_ = in.wave;
      return reflect(
          (f0() + (coupling_.impedance + slope()) * v) / std::sqrt(2 * coupling_.impedance), in);
    }
    port_.allowed = std::max(port_.allowed, in.energy);
    return held_to((port_.left() + coupling_.reserve) / dt_, f0(), slope(), v);
  }

  /// v = sqrt(2/b) u - f/b with f = f0 + slope v; u no more than has come in.
  double by_waves(const Packet& in) EBAC_RT {
    smooth_ += (in.wave - last_ - smooth_ * dt_) / kSmooth;
    last_ = in.wave;
    const double wanted = coupling_.follow ? (in.wave - used_wave_) / kSmooth : smooth_;
    const double v = reflect(wanted, in);
    state_.drift = (in.wave - used_wave_) / std::sqrt(2 * coupling_.impedance);
    return v;
  }

  double reflect(double wanted, const Packet& in) EBAC_RT {
    const double b = coupling_.impedance;
    port_.allowed = std::max(port_.allowed, in.energy);
    const double most = std::sqrt(2 * std::max(0.0, wave_left() + coupling_.reserve) / dt_);
    const double u = std::clamp(wanted, -most, most);
    used_wave_ += u * dt_;
    used_energy_ += 0.5 * u * u * dt_;
    const double v = (std::sqrt(2 * b) * u - f0()) / (b + slope());
    const double w = u - std::sqrt(2 / b) * (f0() + slope() * v);
    wave_sum_ += w * dt_;
    wave_energy_ += 0.5 * w * w * dt_;
    return v;
  }

  void move(double v) EBAC_RT {
    const double force = f0() + slope() * v;
    state_.force = std::clamp(force, -coupling_.peak_force, coupling_.peak_force);
    const double given = state_.force * v * dt_;
    given_ += given;
    port_.add(-given);
    state_.target += v * dt_;
    const double h = dt_ / kSlaveSteps;
    for (int i = 0; i < kSlaveSteps; ++i) {
      state_.met = model_.push(state_.x, state_.v);
      state_.v += h * (state_.force - state_.met - model_.damping * state_.v) / model_.mass;
      state_.x += h * state_.v;
    }
  }

  SlaveModel model_;
  Coupling coupling_;
  double dt_;  // s
  Session session_;
  State state_{};
  PortEnergy port_{};
  bool known_ = true;  // zero_
  bool aligned_ = true;
  double zero_ = 0;         // m, where the master's zero lies
  double last_ = 0;         // m, or sqrt(W) s
  double smooth_ = 0;       // m/s, or sqrt(W)
  double used_wave_ = 0;    // sqrt(W) s
  double used_energy_ = 0;  // J
  double wave_sum_ = 0;     // sqrt(W) s
  double wave_energy_ = 0;  // J
  double given_ = 0;        // J
};

}  // namespace ebac::teleop
