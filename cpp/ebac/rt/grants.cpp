#include "ebac/rt/grants.hpp"

#include <alloca.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <mutex>
#include <string>

namespace ebac::rt {

namespace {

constexpr const char* kLimitsFile = "/etc/security/limits.d/ebac.conf";
constexpr int kCapIpcLock = 14;  // linux/capability.h

std::string soft_limit(int resource) {
  rlimit limit{};
  getrlimit(static_cast<__rlimit_resource>(resource), &limit);
  return limit.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(limit.rlim_cur);
}

/// `line` is for pam_limits, `unit` for systemd, `cap` for setcap.
std::string limit_remedy(const std::string& line, const std::string& unit, const std::string& cap) {
  return "echo \"$(id -un) - " + line + "\" | sudo tee -a " + kLimitsFile +
         "  # then log in again; for a systemd service: " + unit +
         "; for one program: sudo setcap " + cap +
         "+ep \"$(readlink -f \"$(command -v python)\")\"";
}

bool has_capability(int bit) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("CapEff:")) {
      return (std::stoull(line.substr(7), nullptr, 16) >> bit & 1U) != 0;
    }
  }
  return false;
}

std::string cpu_list(const cpu_set_t& set) {
  std::string text;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &set)) continue;
    if (!text.empty()) text += ',';
    text += std::to_string(cpu);
  }
  return text;
}

std::mutex locking;  // of the memory, and of the count of those that hold it
int holders = 0;

/// What is left of the stack of this thread [bytes], but for a margin; all of it where the system does not tell.
std::size_t stack_left() {
  constexpr std::size_t kMargin = 65536;
  pthread_attr_t attributes;
  if (pthread_getattr_np(pthread_self(), &attributes) != 0) {
    return std::numeric_limits<std::size_t>::max();
  }
  void* lowest = nullptr;
  std::size_t size = 0;
  pthread_attr_getstack(&attributes, &lowest, &size);
  pthread_attr_destroy(&attributes);
  // Of the frame, as a sanitizer may keep what lies in it elsewhere.
  const auto here = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
  const std::size_t left = here - reinterpret_cast<std::uintptr_t>(lowest);
  return left > kMargin ? left - kMargin : 0;
}

}  // namespace

Grant ask_priority(int priority) {
  const std::string asked = "SCHED_FIFO " + std::to_string(priority);
  const sched_param parameters{.sched_priority = priority};
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  if (error == 0) return {"priority", asked, true, "", ""};
  return {"priority", asked, false,
          std::string(std::strerror(error)) + "; the limit of real-time priority is " +
              soft_limit(RLIMIT_RTPRIO),
          limit_remedy("rtprio " + std::to_string(priority),
                       "LimitRTPRIO=" + std::to_string(priority), "cap_sys_nice")};
}

Grant ask_cpu(int cpu) {
  const std::string asked = "CPU " + std::to_string(cpu);
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  sched_getaffinity(0, sizeof(allowed), &allowed);
  cpu_set_t wanted;
  CPU_ZERO(&wanted);
  CPU_SET(static_cast<std::size_t>(cpu), &wanted);
  const int error = pthread_setaffinity_np(pthread_self(), sizeof(wanted), &wanted);
  if (error == 0) return {"cpu", asked, true, "", ""};
  const std::string list = cpu_list(allowed);
  return {"cpu", asked, false, std::string(std::strerror(error)) + "; this process may use " + list,
          "choose one of " + list + ", or start with: taskset -c " + std::to_string(cpu) + " ..."};
}

Grant ask_memory() {
  const std::string limit = soft_limit(RLIMIT_MEMLOCK);
  const std::string remedy =
      limit_remedy("memlock unlimited", "LimitMEMLOCK=infinity", "cap_ipc_lock");
  const std::string asked = "all pages locked";
  if (limit != "unlimited" && !has_capability(kCapIpcLock)) {
    return {"memory", asked, false, "the limit of locked memory is " + limit + " bytes", remedy};
  }
  const std::scoped_lock one_by_one(locking);
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    return {"memory", asked, false, std::strerror(errno), remedy};
  }
  ++holders;
  return {"memory", asked, true, "", ""};
}

void release_memory() noexcept {
  const std::scoped_lock one_by_one(locking);
  if (--holders == 0) munlockall();
}

Grant touch_stack(int bytes) {
  const auto size = static_cast<std::size_t>(bytes);
  const std::string asked = std::to_string(bytes) + " bytes touched";
  if (const std::size_t room = stack_left(); size > room) {
    return {"stack", asked, false,
            "the thread has " + std::to_string(room) + " bytes left beside a margin",
            "choose at most " + std::to_string(room) + ", or start with a larger one: ulimit -s"};
  }
  auto* memory = static_cast<volatile char*>(alloca(size + 1));
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  for (std::size_t i = 0; i < size; i += page) memory[i] = 0;
  return {"stack", asked, true, "", ""};
}

}  // namespace ebac::rt
