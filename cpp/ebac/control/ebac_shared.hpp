#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/control/commands_in_flight.hpp"
#include "ebac/control/ebac_params.hpp"
#include "ebac/control/energy_ledger.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/core/sample.hpp"
#include "ebac/core/timing.hpp"

namespace ebac {

/// What the two ways of `Ebac` to a command share: parameters, the account, commands in flight, and
/// the state that is recorded.
struct EbacShared {
  EbacParams params;
  Timing timing;
  EbacState state{};
  EnergyLedger ledger;
  CommandsInFlight in_flight;
  CommandsInFlight asked;     // N, of the world: for the commands in flight and the one that acts
  CommandsInFlight surfaces;  // m/s, of the world's surface: as it moved for each of them
  double command = 0;         // N, of the last tick
  double world_v = 0;         // m/s, of the last tick
  double f_env = 0;           // N, of the last tick
  double f_meas = 0;          // N, of the last tick
  double rising = 0, falling = 0;  // N/s, quickest change of it lately
  double kept = 0;                 // share of them, per tick
  double per_dt = 0;               // 1/s

  EbacShared(const EbacParams& given, const Timing& tick) EBAC_RT
      : params(given),
        timing(tick),
        ledger(given.damping, given.count, given.current_lag, given.reserve),
        in_flight(tick.delay),
        asked(tick.delay + 1),
        surfaces(tick.delay + 1) {
    state.energy = given.reserve;
  }

  /// Values that depend on the time since the last tick alone.
  void set_tick(double dt) EBAC_RT {
    ledger.set_tick(dt);
    kept = kForget / (kForget + dt);
    per_dt = 1 / dt;
  }

  double held(double force) const EBAC_RT {
    return std::clamp(force, -params.peak_force, params.peak_force);
  }

  /// Way of the world's surface over the last interval [m]. With the observer a world is met, and declares its velocity,
  /// for when the command acts: it was declared with the force that acted now.
  double surface(const Port& port) EBAC_RT {
    const double mean = 0.5 * (world_v + port.world_v);
    world_v = port.world_v;
    return (mean + port.est.weight * (surfaces[0] - mean)) * port.dt;
  }

  /// Largest pull of the hand against `wanted` until the command has acted, from what the force sensor shows [N].
  double pull_shown(double wanted, const Port& port) const EBAC_RT {
    const double shown = std::max(0.0, wanted > 0 ? -port.f_meas : port.f_meas);
    const double unseen = (timing.delay + 1) * port.dt + kBehind;
    const double let_go = wanted > 0 ? falling : rising, pushed = wanted > 0 ? rising : falling;
    const double rate = std::max({params.pull_rate, let_go, kAsQuick * pushed});
    return std::min(params.pull, shown + kSensor + rate * unseen);
  }

  /// Keeps how quickly the force of the hand has changed in the last tenth of a second: one that has let go faster than
  /// declared will do so again, and one that has pushed so may let go a fifth as fast.
  void watch_hand(const Port& port) EBAC_RT {
    const double change = port.f_meas - f_meas, noise = kNoise * params.force_noise;
    f_meas = port.f_meas;
    rising = std::max((change - noise) * per_dt, rising * kept);
    falling = std::max((-change - noise) * per_dt, falling * kept);
  }

  /// What the account is lent in a contact at rest that the law gives the observer up for [J]. Only with a sensor
  /// noisier than usual does the noise alone use the account up, and the noisier, the more is needed.
  double reserve_at_rest() const EBAC_RT {
    const double least = params.observed_reserve;
    return std::clamp(least * ObservedWork::noisier(params.force_noise), least,
                      std::max(least, params.reserve));
  }

  /// The guard lets less through.
  void limited(double command_given, double wanted) EBAC_RT {
    state.clamped = true;
    state.admitted = command_given / wanted;
  }

  /// The command is given; `stored_at` is the stiffness at which contact can have stored energy.
  void give(double given, const Port& port, double stored_at) EBAC_RT {
    command = given;
    f_env = port.f_env;
    in_flight.push(given);
    asked.push(port.f_env);
    surfaces.push(port.world_v);
    ledger.leak(given, stored_at);
    state.energy = ledger.energy();
    const double longer = state.admitted < kShort ? port.dt : -kFed * port.dt;
    state.starved = std::max(0.0, state.starved + longer);
  }

 private:
  static constexpr double kSensor = 0.5;   // N, error of the force sensor the guard counts with
  static constexpr double kBehind = 1e-3;  // s, lag of a usual force sensor and age of its reading
  static constexpr double kNoise = 4;      // standard deviations of the sensor in a change
  static constexpr double kForget = 0.1;   // s
  static constexpr double kAsQuick = 0.2;  // with 0 searches draw more, with 0.3 walls are lost
  static constexpr double kShort = 0.5;    // of a command: less is starved
  static constexpr double kFed = 10;       // s by which `starved` falls in a second
};

}  // namespace ebac
