#include "ebac/can/wake_event.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>

namespace ebac::can {

static_assert(sizeof(std::atomic<std::uint32_t>) == sizeof(std::uint32_t));
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

void WakeEvent::wake(int most) noexcept {
  sequence_.fetch_add(1, std::memory_order_acq_rel);
  ::syscall(SYS_futex, &sequence_, FUTEX_WAKE_PRIVATE, most, nullptr, nullptr, 0);
}

bool WakeEvent::sleep(std::uint32_t sequence, std::chrono::nanoseconds most) noexcept {
  if (most.count() <= 0) return false;
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(most);
  const timespec span{.tv_sec = whole.count(), .tv_nsec = (most - whole).count()};
  if (::syscall(SYS_futex, &sequence_, FUTEX_WAIT_PRIVATE, sequence, &span, nullptr, 0) == 0)
    return true;
  return errno == EAGAIN;  // signalled meanwhile
}

}  // namespace ebac::can
