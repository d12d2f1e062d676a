#include "ebac/can/wake_event.hpp"

#include <algorithm>
#include <thread>

namespace ebac::can {

void WakeEvent::wake(int) noexcept { sequence_.fetch_add(1, std::memory_order_acq_rel); }

bool WakeEvent::sleep(std::uint32_t sequence, std::chrono::nanoseconds most) noexcept {
  constexpr std::chrono::nanoseconds kNap = std::chrono::microseconds{100};
  const auto end = std::chrono::steady_clock::now() + most;
  while (sequence_.load(std::memory_order_acquire) == sequence) {
    const auto left = end - std::chrono::steady_clock::now();
    if (left.count() <= 0) return false;
    std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(left, kNap));
  }
  return true;
}

}  // namespace ebac::can
