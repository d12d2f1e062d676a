#include "ebac/rt/jitter.hpp"

#include "ebac/rt/monotonic_clock.hpp"
#include "ebac/rt/thread.hpp"

namespace ebac::rt {

Jitter measure_jitter(double dt, std::int64_t ticks, Mode mode, const Options& options,
                      const std::atomic<bool>& cancelled) {
  Jitter jitter;
  jitter.lateness.reserve(static_cast<std::size_t>(ticks));
  Thread thread(mode, options, [&] {
    MonotonicClock clock(dt);
    clock.wait();
    for (std::int64_t tick = 0; tick < ticks && !cancelled; ++tick) {
      const Instant now = clock.wait();
      jitter.lateness.push_back(now.lateness + dt * static_cast<double>(now.skipped));
      tick += now.skipped;
    }
    jitter.skipped = clock.skipped();
  });
  thread.join();
  jitter.report = thread.report();
  return jitter;
}

}  // namespace ebac::rt
