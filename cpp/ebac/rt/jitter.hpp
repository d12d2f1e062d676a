#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "ebac/rt/options.hpp"
#include "ebac/rt/report.hpp"

namespace ebac::rt {

/// How late a thread woke that did nothing but wait for its ticks.
struct Jitter {
  std::vector<double> lateness;  // s, from the planned instant, of every wake-up
  std::int64_t skipped = 0;      // ticks that could not be kept
  Report report;
};

/// Waits for `ticks` ticks of `dt` [s] in a thread of its own. Ends early once `cancelled`. Throws
/// as rt::Thread does.
Jitter measure_jitter(double dt, std::int64_t ticks, Mode mode, const Options& options,
                      const std::atomic<bool>& cancelled);

}  // namespace ebac::rt
