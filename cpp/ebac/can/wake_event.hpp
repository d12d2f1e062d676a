#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>

namespace ebac::can {

/// Wakes who waits for something that others bring. Ringing where nobody waits is one atomic
/// operation and no system call.
class Doorbell {
 public:
  /// After something was brought.
  void ring() noexcept {
    // Read by writing: of this and the visitor's own count one comes first. Then either the visitor
    // sees what was brought, or this sees the visitor.
    if (waiting_.fetch_add(0, std::memory_order_acq_rel) > 0) wake(1);
  }
  void ring_for_all() noexcept { wake(kAll); }

  /// Sleeps until `look` is true or the time is over: whether it was. `look` is asked at once, and
  /// once more at the end.
  template <class Look>
  bool wait(std::chrono::nanoseconds timeout, Look look) noexcept {
    const auto end = std::chrono::steady_clock::now() + std::min(timeout, kLongest);
    waiting_.fetch_add(1, std::memory_order_acq_rel);
    bool seen = false;
    for (bool more = true; more;) {
      const std::uint32_t rung = rung_.load(std::memory_order_acquire);
      seen = look();
      more = !seen && sleep(rung, end - std::chrono::steady_clock::now());
    }
    waiting_.fetch_sub(1, std::memory_order_acq_rel);
    return seen || look();
  }

 private:
  static constexpr int kAll = 0x7FFFFFFF;
  // A year: the sum with the clock's time must not overflow.
  static constexpr std::chrono::nanoseconds kLongest = std::chrono::hours{24 * 365};

  void wake(int most) noexcept;
  /// Until it rings after `rung`. False when the time is over or a signal came.
  bool sleep(std::uint32_t rung, std::chrono::nanoseconds most) noexcept;

  std::atomic<std::uint32_t> rung_{0};
  std::atomic<int> waiting_{0};
};

}  // namespace ebac::can
