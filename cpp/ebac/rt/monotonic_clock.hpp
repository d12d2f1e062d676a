#pragma once

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <string_view>
#include <thread>

#include "ebac/core/clock.hpp"
#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac::rt {

/// Sleeps to the next absolute tick of CLOCK_MONOTONIC. A missed tick is skipped and counted, never
/// made up for: the next one comes at its planned instant. Starts at the first `wait`. Takes the
/// sample time in s.
class MonotonicClock {
 public:
  /// Columns of a trace.
  struct State {
    double busy = 0;  // s
    static constexpr auto fields() {
      return std::array{
          Field<State>{"busy", &State::busy, "s", "time from the wake-up to the end of the tick"}};
    }
  };
  static constexpr std::string_view kPrefix = "time.";

  explicit MonotonicClock(double dt) EBAC_RT : period_(std::llround(dt* kSecond)) {}

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

  /// The work of a tick is done.
  void finish() EBAC_RT { state_.busy = seconds(now() - last_); }
  const State& state(std::size_t) const EBAC_RT { return state_; }

  std::int64_t skipped() const EBAC_RT { return skipped_; }  // ticks, since the start

  static std::int64_t now() EBAC_RT {  // ns; on Linux CLOCK_MONOTONIC
    return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

 private:
  static constexpr int kSecond = 1'000'000'000;  // ns

  Instant begin() EBAC_RT {
    start_ = planned_ = last_ = now();
    return {};
  }
  static void sleep_to(std::int64_t instant) EBAC_RT {
#ifdef EBAC_PORTABLE
    std::this_thread::sleep_for(std::chrono::nanoseconds(instant - now()));
#else
    const timespec time{.tv_sec = instant / kSecond, .tv_nsec = instant % kSecond};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
    }
#endif
  }
  static double seconds(std::int64_t ns) EBAC_RT { return static_cast<double>(ns) * 1e-9; }

  std::int64_t period_;       // ns
  std::int64_t start_ = 0;    // ns
  std::int64_t planned_ = 0;  // ns, of the last tick
  std::int64_t last_ = 0;     // ns, when it woke
  std::int64_t skipped_ = 0;  // ticks
  State state_{};
};

static_assert(Clock<MonotonicClock>);

}  // namespace ebac::rt
