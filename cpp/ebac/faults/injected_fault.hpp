#pragma once

#include <cstdint>

#include "ebac/faults/kind.hpp"

namespace ebac::faults {

/// One case of a campaign: kind, time, duration and axis of the injected fault.
struct InjectedFault {
  Kind kind = Kind::kStop;
  std::int64_t at = 0;  // the tick in which it begins
  int ticks = 1;
  std::size_t axis = 0;
  std::uint64_t chance = 0;  // random number for further details of the case
  std::int64_t tick = -1;    // now

  // Consequences, as seen by the drives and motors.
  std::int64_t last_command = -1;  // last tick with a torque on the bus
  std::int64_t last_current = -1;  // last tick in which a motor had current
  double most_current = 0;         // A, of any motor

  bool on(Kind what) const EBAC_RT { return kind == what && tick >= at && tick < at + ticks; }
  bool begins(Kind what) const EBAC_RT { return kind == what && tick == at; }
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
