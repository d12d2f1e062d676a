#include "ebac/rt/awake_cpus.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>

namespace ebac::rt {

namespace {

std::string remedy(const char* file, int error) {
  if (error == ENOENT) {
    return "this kernel, or container, does not have it; give a container the device, or ask for "
           "nothing: stay_awake = false";
  }
  return std::string("sudo chmod a+rw ") + file +
         "  # until the machine starts again; for good: echo 'KERNEL==\"cpu_dma_latency\", "
         "MODE=\"0666\"' | sudo tee /etc/udev/rules.d/60-ebac.rules";
}

}  // namespace

AwakeCpus::~AwakeCpus() { let_go(); }

void AwakeCpus::let_go() noexcept {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

Grant AwakeCpus::ask() {
  constexpr std::int32_t kLongest = 0;  // us, to wake up
  const std::string asked = "idle CPUs that do not sleep";
  let_go();
  file_ = ::open(name_, O_WRONLY | O_CLOEXEC);
  int error = errno;
  if (file_ >= 0) {
    const auto written = ::write(file_, &kLongest, sizeof(kLongest));
    if (written == sizeof(kLongest)) return {"sleep", asked, true, "", ""};
    error = written < 0 ? errno : EIO;  // a part of it is no request, and sets no errno
  }
  let_go();
  return {"sleep", asked, false, std::string(name_) + ": " + std::strerror(error),
          remedy(name_, error)};
}

}  // namespace ebac::rt
