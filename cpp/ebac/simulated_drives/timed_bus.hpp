#pragma once

#include <array>
#include <cstdint>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac::can {

/// A bus that takes time in a simulated run, and the watches of its drives and its loop.
struct TimedBus {
  double bit_rate = 1e6;          // bit/s
  double answer_share = 0.7;      // of a tick
  double response = 50e-6;        // s
  double error_rate = 0;          // of frames
  int broken = 0;                 // node
  double broken_from = 0;         // s
  int silent_ticks = 3;           // samples
  double drive_heartbeat = 0.1;   // s
  double loop_silence = 0.3;      // s
  double torque_silence = 0.005;  // s
  double peak_ratio = 10;         // peak torque of the drives over rated torque
  std::int64_t seed = 0;

  static constexpr auto fields() {
    using F = Field<TimedBus>;
    return std::array{
        F{"bit_rate", &TimedBus::bit_rate, "bit/s", "bit rate of the bus", 1e4, 1e6},
        F{"answer_share", &TimedBus::answer_share, "1",
          "how long the loop waits for the drives' answers, over the sample time", 0.05, 0.9},
        F{"response", &TimedBus::response, "s", "time a drive takes from a frame to its answer", 0,
          0.1},
        F{"error_rate", &TimedBus::error_rate, "1", "probability that a frame is destroyed", 0, 1},
        F{"broken", &TimedBus::broken, "1",
          "node whose every frame is destroyed, the first one being 1; 0 for none", 0, kMaxAxes},
        F{"broken_from", &TimedBus::broken_from, "s", "time from which it is broken", 0, 1e5},
        F{"silent_ticks", &TimedBus::silent_ticks, "samples",
          "ticks in a row without process data that are a fault", 1, 1000},
        F{"drive_heartbeat", &TimedBus::drive_heartbeat, "s",
          "time between two heartbeats of a drive; 0 sends none", 0, 60},
        F{"loop_silence", &TimedBus::loop_silence, "s",
          "time without the loop's heartbeat that is a fault of a drive; 0 watches none", 0, 60},
        F{"torque_silence", &TimedBus::torque_silence, "s",
          "time without a torque that is a fault of a drive; 0 watches none", 0, 60},
        F{"peak_ratio", &TimedBus::peak_ratio, "1",
          "largest torque that the drives let through over the rated one (0x6072, 0x6073); that of "
          "the device limits it, too",
          1e-3, 65},
        F{"seed", &TimedBus::seed, "1", "seed of what is destroyed", 0, 9e15},
    };
  }
};

}  // namespace ebac::can
