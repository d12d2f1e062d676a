#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "ebac/core/check.hpp"
#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac::teleop {

/// How master and slave are coupled through the network.
enum class Scheme : int {
  kPositionForce = 0,  // position there, force back
  kPassivity = 1,      // the same, with passivity observers and controllers at both ports
  kWaves = 2,          // wave variables
};

/// The coupling, the same on both sides.
struct Coupling {
  int scheme = 0;
  double impedance = 20;  // N s/m
  double injection = 20;  // N s/m
  double reserve = 5e-3;  // J
  bool follow = true;
  bool measured = false;
  double stiffness = 4000;  // N/m
  double damping = 40;      // N s/m
  double catch_up = 0.1;    // m/s
  double realign = 0.02;    // m/s
  double fastest = 0.3;     // m/s
  double buffer = 0;        // s
  double timeout = 0.5;     // s
  double fade = 0.2;        // s
  double peak_force = 30;   // N

  static constexpr auto fields() {
    using F = Field<Coupling>;
    return std::array{
        F{"scheme", &Coupling::scheme, "1", "0 position and force, 1 passivity control, 2 waves", 0,
          2},
        F{"impedance", &Coupling::impedance, "N s/m",
          "wave impedance b; damping of the slave's controller with waves", 0.1, 1e3},
        F{"injection", &Coupling::injection, "N s/m",
          "largest damping of the master's passivity controller", 0, 1e3},
        F{"follow", &Coupling::follow, "1",
          "compensate position drift, with energy that is left over; 0 leaves it", 0, 1},
        F{"reserve", &Coupling::reserve, "J",
          "energy that each port may give out before any has come in: without it nothing begins to "
          "move",
          0, 1},
        F{"measured", &Coupling::measured, "1",
          "1 sends the force of the environment back, 0 that of the slave's controller", 0, 1},
        F{"stiffness", &Coupling::stiffness, "N/m", "of the slave's position controller", 1, 1e5},
        F{"damping", &Coupling::damping, "N s/m",
          "of the slave's position controller; with waves it is their impedance", 0, 1e3},
        F{"catch_up", &Coupling::catch_up, "m/s",
          "largest speed at which drift is compensated, on top of the motion", 0, 10},
        F{"realign", &Coupling::realign, "m/s",
          "largest speed at which the slave goes back to the master's place after consent to go "
          "on; "
          "0 goes on from where both are",
          0, 1},
        F{"fastest", &Coupling::fastest, "m/s",
          "position and force: largest speed of the slave's target, after a gap in what comes",
          0.01, 10},
        F{"buffer", &Coupling::buffer, "s",
          "play-out buffer of both receivers, against jitter and loss; it adds to the delay", 0,
          0.3},
        F{"timeout", &Coupling::timeout, "s", "silence after which the link counts as lost", 0.01,
          10},
        F{"fade", &Coupling::fade, "s", "in which the master's force goes to zero and comes back",
          1e-3, 10},
        F{"peak_force", &Coupling::peak_force, "N", "largest force of the slave", 0.1, 1e4},
    };
  }
};

/// Packets that a receiver keeps for its play-out buffer.
inline constexpr std::uint32_t kRing = 1024;

/// Returns the coupling; throws std::invalid_argument for a field out of its range, a buffer of more packets than a
/// receiver keeps, and a time-out within a tick of `dt` [s].
inline const Coupling& checked_coupling(const Coupling& coupling, double dt) {
  check(coupling, "Coupling");
  if (!(coupling.buffer < (kRing - 1) * dt)) {
    throw std::invalid_argument(
        range_message("Coupling", "buffer", coupling.buffer, "s", 0, (kRing - 2) * dt) +
        ", as many packets as a receiver keeps");
  }
  if (!(coupling.timeout > 2 * dt)) {
    throw std::invalid_argument("Coupling.timeout = " + shortest(coupling.timeout) +
                                " s: must be longer than two ticks, " + shortest(2 * dt) + " s");
  }
  return coupling;
}

/// What comes in is followed with this lag: encoder counts would be blows otherwise [s].
inline constexpr double kSmooth = 5e-3;

/// Where a side of the link stands.
enum class LinkState : int {
  kWaiting = 0,  // nothing has come yet
  kRunning = 1,
  kLost = 2,  // the slave holds, the master's force fades
  kBack = 3,  // packets come again; the hand has not consented
};

/// Energy at one port of the network since the session began, split by direction as Ryu, Artigas and
/// Preusche (2010) do, so that each part only grows and may be sent.
struct PortEnergy {
  double in = 0;          // J, into the network
  double out = 0;         // J, out of it
  double allowed = 0;     // J, that has come in at the other port, as far as known here
  double dissipated = 0;  // J, by what holds the port passive
  double debt = 0;        // J, of the reserve, spent in earlier sessions

  void add(double joule) EBAC_RT {
    if (joule > 0)
      in += joule;
    else
      out -= joule;
  }
  /// What may still go out, before the reserve.
  double left() const EBAC_RT { return allowed + dissipated - out - debt; }
  /// A new session, after one that ended with `left`: what it spent of the reserve stays spent.
  void begin(double left) EBAC_RT { *this = {.debt = std::max(0.0, -left)}; }
};

/// The speeds v at which a port of the force f0 + slope v gives out at most `power`: the roots of slope v^2 +
/// f0 v = power on either side of zero; `power` and `slope` at least 0.
inline double held_to(double power, double f0, double slope, double v) EBAC_RT {
  if (v == 0 || (f0 + slope * v) * v <= power) return v;
  const double p = std::max(power, 0.0);
  const double root = std::sqrt(f0 * f0 + 4 * slope * p);
  // The root that does not cancel.
  const double q = -0.5 * (f0 + std::copysign(root, f0));
  const double one = slope > 0 ? q / slope : 0.0;
  const double other = q != 0 ? -p / q : 0.0;
  const double low = std::min({one, other, 0.0});
  const double high = std::max({one, other, 0.0});
  if (!(slope > 0)) return f0 * v > 0 ? p / f0 : v;
  return std::clamp(v, low, high);
}

}  // namespace ebac::teleop
