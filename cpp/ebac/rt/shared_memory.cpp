#include "ebac/rt/shared_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>

namespace ebac::rt {

namespace {

[[noreturn]] void refuse(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

SharedMemory::SharedMemory(std::size_t bytes)
    : bytes_(bytes), descriptor_(memfd_create("ebac", MFD_CLOEXEC)) {
  if (descriptor_ < 0) refuse("memory to share");
  if (ftruncate(descriptor_, static_cast<off_t>(bytes)) != 0) {
    close(descriptor_);
    refuse("memory to share");
  }
  map();
}

SharedMemory::SharedMemory(int descriptor, std::size_t bytes)
    : bytes_(bytes), descriptor_(fcntl(descriptor, F_DUPFD_CLOEXEC, 0)) {
  const std::string name = "memory of another process at descriptor " + std::to_string(descriptor);
  if (descriptor_ < 0) refuse(name.c_str());
  struct stat facts{};
  if (fstat(descriptor_, &facts) != 0 || facts.st_size != static_cast<off_t>(bytes)) {
    close(descriptor_);
    throw std::invalid_argument(name + ": has not the " + std::to_string(bytes) +
                                " bytes expected; both must be of the same version");
  }
  map();
}

void SharedMemory::map() {
  at_ = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
  if (at_ != MAP_FAILED) return;
  const int error = errno;
  close(descriptor_);
  errno = error;
  refuse("memory to share");
}

SharedMemory::~SharedMemory() {
  munmap(at_, bytes_);
  close(descriptor_);
}

}  // namespace ebac::rt
