#include "ebac/rt/awake_cpus.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>

namespace ebac::rt {

namespace {

constexpr const char* kFile = "/dev/cpu_dma_latency";

std::string remedy(int error) {
  if (error == ENOENT) {
    return "this kernel, or container, does not have it; give a container the device, or ask for "
           "nothing: stay_awake = false";
  }
  return std::string("sudo chmod a+rw ") + kFile +
         "  # until the machine starts again; for good: echo 'KERNEL==\"cpu_dma_latency\", "
         "MODE=\"0666\"' | sudo tee /etc/udev/rules.d/60-ebac.rules";
}

}  // namespace

AwakeCpus::~AwakeCpus() {
  if (file_ >= 0) ::close(file_);
}

Grant AwakeCpus::ask() {
  constexpr std::int32_t kLongest = 0;  // us, to wake up
  const std::string asked = "idle CPUs that do not sleep";
  file_ = ::open(kFile, O_WRONLY | O_CLOEXEC);
  if (file_ >= 0 && ::write(file_, &kLongest, sizeof(kLongest)) == sizeof(kLongest)) {
    return {"sleep", asked, true, "", ""};
  }
  const int error = errno;
  return {"sleep", asked, false, std::string(kFile) + ": " + std::strerror(error), remedy(error)};
}

}  // namespace ebac::rt
