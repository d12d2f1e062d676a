#pragma once

#include <cerrno>
#include <cstdint>
#include <ctime>

#include "ebac/core/concepts.hpp"

namespace ebac::rt {

/// Sleeps to the next absolute tick of CLOCK_MONOTONIC. A tick that could not be kept is skipped and
/// counted, never made up for: the one after it comes at its planned instant. Starts at the first
/// `wait`. Takes the sample time in s.
class MonotonicClock {
 public:
  explicit MonotonicClock(double dt) EBAC_RT
      : period_(static_cast<std::int64_t>(dt* kSecond + 0.5)) {}

  Instant wait() EBAC_RT {
    if (start_ == 0) return begin();
    planned_ += period_;
    sleep_to(planned_);
    const std::int64_t woke = now();
    const std::int64_t missed = (woke - planned_) / period_;  // whole ticks gone by
    planned_ += missed * period_;
    skipped_ += missed;
    const Instant instant{.t = seconds(woke - start_),
                          .dt = seconds(woke - last_),
                          .lateness = seconds(woke - planned_),
                          .skipped = missed};
    last_ = woke;
    return instant;
  }

  std::int64_t skipped() const EBAC_RT { return skipped_; }  // ticks, since the start

  static std::int64_t now() EBAC_RT {  // ns
    timespec time{};
    clock_gettime(CLOCK_MONOTONIC, &time);
    return time.tv_sec * std::int64_t{kSecond} + time.tv_nsec;
  }

 private:
  static constexpr int kSecond = 1'000'000'000;  // ns

  Instant begin() EBAC_RT {
    start_ = planned_ = last_ = now();
    return {};
  }
  static void sleep_to(std::int64_t instant) EBAC_RT {
    const timespec time{.tv_sec = instant / kSecond, .tv_nsec = instant % kSecond};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
    }
  }
  static double seconds(std::int64_t ns) EBAC_RT { return static_cast<double>(ns) * 1e-9; }

  std::int64_t period_;       // ns
  std::int64_t start_ = 0;    // ns
  std::int64_t planned_ = 0;  // ns, of the last tick
  std::int64_t last_ = 0;     // ns, when it woke
  std::int64_t skipped_ = 0;  // ticks
};

static_assert(Clock<MonotonicClock>);

}  // namespace ebac::rt
