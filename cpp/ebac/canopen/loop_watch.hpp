#pragma once

#include <cstdint>
#include <string>

/// How long a drive waits for its loop before it lets go, against how often the loop sends.
namespace ebac::can {

/// What a drive watches of its loop.
struct LoopWatch {
  std::string name;     // of the setting
  double seconds = 0;   // s, as it is given
  std::int64_t ms = 0;  // as the drive counts it; 0 for no watch
  std::string what;     // the loop sends: torque, heartbeat, request
  double period = 0;    // s, between two of them; 0 for one in every tick
};

/// Shortest time between two heartbeats of a loop [s].
inline constexpr double kLeastBeat = 1e-3;
/// Heartbeats of a loop in the time for which a drive waits for one.
inline constexpr double kBeatsInSilence = 10;

/// Time between two heartbeats of a loop [s] whose drives let go after `silence` [s] without one, and wait for a minute
/// at most.
double beat_period(double silence);

/// Time from one to the next of what a loop with ticks of `dt` [s] sends after `period` [s]: whole ticks.
double sent_every(double period, double dt);

/// Throws std::invalid_argument, with the remedy, for a watch that ends before a loop that is in time sends again.
void check_watch(const LoopWatch& watch, double dt);

}  // namespace ebac::can
