#include "ebac/rt/other_process.hpp"

#include <poll.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace ebac::rt {

int own_process() noexcept { return getpid(); }

bool process_lives(int process) noexcept {
  if (process <= 0) return false;
  const int descriptor = static_cast<int>(syscall(SYS_pidfd_open, process, 0));
  if (descriptor <
      0) {  // there is none, or a kernel before 5.3 cannot say: then by a signal that is none
    return errno != ESRCH && (kill(process, 0) == 0 || errno == EPERM);
  }
  pollfd watched{.fd = descriptor, .events = POLLIN, .revents = 0};
  const bool ended = poll(&watched, 1, 0) > 0;
  close(descriptor);
  return !ended;
}

}  // namespace ebac::rt
