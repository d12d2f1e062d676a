#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>

namespace ebac::can {

/// Wakes a thread that waits for work of other threads. Signalling while no thread waits costs one
/// atomic operation and no system call.
class WakeEvent {
 public:
  /// To be called after work was added.
  void signal() noexcept {
    // Read by writing: this and the waiting thread's own count are ordered. Either the waiting
    // thread sees the new work, or this call sees the waiting thread.
    if (waiting_.fetch_add(0, std::memory_order_acq_rel) > 0) wake(1);
  }
  void signal_all() noexcept { wake(kAll); }

  /// Sleeps until `look` returns true or the time is over; returns whether it did. `look` is called
  /// at once, and once more at the end.
  template <class Look>
  bool wait(std::chrono::nanoseconds timeout, Look look) noexcept {
    const auto end = std::chrono::steady_clock::now() + std::min(timeout, kLongest);
    waiting_.fetch_add(1, std::memory_order_acq_rel);
    bool seen = false;
    for (bool more = true; more;) {
      const std::uint32_t sequence = sequence_.load(std::memory_order_acquire);
      seen = look();
      more = !seen && sleep(sequence, end - std::chrono::steady_clock::now());
    }
    waiting_.fetch_sub(1, std::memory_order_acq_rel);
    return seen || look();
  }

 private:
  static constexpr int kAll = 0x7FFFFFFF;
  // A year: the sum with the clock's time must not overflow.
  static constexpr std::chrono::nanoseconds kLongest = std::chrono::hours{24 * 365};

  void wake(int most) noexcept;
  /// Until the next signal after `sequence`. False when the time is over or the thread is interrupted.
  bool sleep(std::uint32_t sequence, std::chrono::nanoseconds most) noexcept;

  std::atomic<std::uint32_t> sequence_{0};
  std::atomic<int> waiting_{0};
};

}  // namespace ebac::can
