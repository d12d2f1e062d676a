#include "ebac/can/doorbell.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>

namespace ebac::can {

static_assert(sizeof(std::atomic<std::uint32_t>) == sizeof(std::uint32_t));
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

void Doorbell::wake(int most) noexcept {
  rung_.fetch_add(1, std::memory_order_acq_rel);
  ::syscall(SYS_futex, &rung_, FUTEX_WAKE_PRIVATE, most, nullptr, nullptr, 0);
}

bool Doorbell::sleep(std::uint32_t rung, std::chrono::nanoseconds most) noexcept {
  if (most.count() <= 0) return false;
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(most);
  const timespec span{.tv_sec = whole.count(), .tv_nsec = (most - whole).count()};
  if (::syscall(SYS_futex, &rung_, FUTEX_WAIT_PRIVATE, rung, &span, nullptr, 0) == 0) return true;
  return errno == EAGAIN;  // it rang meanwhile
}

}  // namespace ebac::can
