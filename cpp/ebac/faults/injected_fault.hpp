#pragma once

#include <cstdint>

#include "ebac/faults/kind_facts.hpp"

namespace ebac::faults {

/// Whether the law asks for more than the device has.
constexpr bool asks_all(Kind kind) EBAC_RT {
  return kind == Kind::kForceAtStart || kind == Kind::kForceSwings || kind == Kind::kForceHeld ||
         kind == Kind::kPause || kind == Kind::kNanJoint;
}

/// One case of a campaign: kind, time, duration and axis of the injected fault.
struct InjectedFault {
  Kind kind = Kind::kStop;
  std::int64_t at = 0;  // the tick in which it begins
  int ticks = 1;
  std::size_t axis = 0;
  std::uint64_t chance = 0;  // random number for further details of the case
  std::int64_t tick = -1;    // now

  // Consequences, as seen on the bus, by the motors, and by the law.
  std::int64_t last_command = -1;  // last tick in which the loop sent a torque
  std::int64_t last_current = -1;  // last tick in which a motor had current
  std::int64_t last_asked = -1;    // last tick in which the law was asked
  bool endless = false;            // the loop did not end by itself

  bool on(Kind what) const EBAC_RT { return kind == what && tick >= at && tick < at + ticks; }
  bool begins(Kind what) const EBAC_RT { return kind == what && tick == at; }
  bool ends(Kind what) const EBAC_RT { return kind == what && tick == at + ticks; }
  /// Whether torques of drives may be late, or not the loop's.
  bool strains() const EBAC_RT { return facts_of(kind).strained && tick >= at; }
  /// Whether it asks for force against +x first.
  bool asks_against() const EBAC_RT { return (chance >> 20U & 1U) != 0; }
  /// Whether a stop is asked for without its ramp.
  bool at_once() const EBAC_RT { return (chance >> 21U & 1U) != 0; }
  bool asks_now() const EBAC_RT { return asks_all(kind) && (tick >= at || kind == Kind::kPause); }
  /// Whether the loop must detect it.
  bool fatal() const EBAC_RT {
    const int from = facts_of(kind).fatal;
    return from > 0 && ticks >= from;
  }
  /// Whether the loop must tolerate it.
  bool harmless() const EBAC_RT {
    const KindFacts& facts = facts_of(kind);
    return facts.fatal == 0 || ticks < facts.fatal - facts.slack;
  }
};

}  // namespace ebac::faults
