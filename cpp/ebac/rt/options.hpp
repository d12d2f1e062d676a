#pragma once

#include <array>
#include <cstdint>

#include "ebac/core/fields.hpp"

namespace ebac::rt {

enum class Mode : std::uint8_t {
  kOff,      // an ordinary thread
  kAuto,     // use what the system grants and report refusals
  kEnforce,  // all of it, or do not start
};

/// Real-time resources for the thread of a loop.
struct Options {
  int priority = 80;
  int cpu = -1;
  bool lock_memory = true;
  int stack = 262144;  // bytes
  bool stay_awake = true;

  static constexpr auto fields() {
    using F = Field<Options>;
    return std::array{
        F{"priority", &Options::priority, "1", "priority under SCHED_FIFO", 1, 99},
        F{"cpu", &Options::cpu, "1", "the CPU it stays on; -1 for any", -1, 1023},
        F{"lock_memory", &Options::lock_memory, "1",
          "keep all pages of the process in memory (mlockall)", 0, 1},
        F{"stack", &Options::stack, "bytes", "stack touched before the start; 0 for none", 0,
          4194304},
        F{"stay_awake", &Options::stay_awake, "1",
          "keep idle CPUs from sleeping while it runs (/dev/cpu_dma_latency)", 0, 1},
    };
  }
};

}  // namespace ebac::rt
