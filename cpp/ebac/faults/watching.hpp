#pragma once

#include <array>
#include <cstdint>

#include "ebac/faults/injected_fault.hpp"
#include "ebac/simulated_drives/watched_drives.hpp"

namespace ebac::faults {

/// How loop and drives watch each other, as a run sets it from a shipped profile.
struct Watching {
  can::Watches drives{};
  std::int64_t guarded = 0;  // ms, without a request of node guarding; 0 for a drive that is not
  double timeout = 0;        // s, heartbeat of a drive
  double beat = 0;           // s, between two heartbeats of the loop, or requests

  /// Longest time that a drive keeps its torque without the loop [ms].
  std::int64_t longest() const EBAC_RT {
    if (drives.torque_silence > 0) return drives.torque_silence;
    return guarded > 0 ? guarded : drives.loop_silence;
  }
  /// Ticks of 1 ms until the loop has heard that every drive is operational.
  int before() const EBAC_RT {
    return static_cast<int>(guarded > 0 ? guarded / 5 : drives.drive_heartbeat) + 10;
  }
};

inline constexpr std::array<Watching, 3> kWatchings{{
    // copley-accelnet, copley-xenus
    {.drives = {.drive_heartbeat = 100, .loop_silence = 100, .torque_silence = 5},
     .timeout = 0.3,
     .beat = 0.01},
    // elmo-gold, maxon-epos4, trinamic-tmcm, generic-cia402
    {.drives = {.drive_heartbeat = 100, .loop_silence = 100}, .timeout = 0.3, .beat = 0.01},
    // copley-guarded
    {.guarded = 100, .timeout = 0.1, .beat = 0.02},
}};

/// Any of them, but for a fault that only some drives notice, or bear.
inline const Watching& watching_of(const InjectedFault& injected) EBAC_RT {
  if (injected.kind == Kind::kLostCommand) return kWatchings[0];
  const std::size_t first = injected.kind == Kind::kPause ? 1 : 0;
  return kWatchings[first + (injected.chance >> 7U) % (kWatchings.size() - first)];
}

}  // namespace ebac::faults
