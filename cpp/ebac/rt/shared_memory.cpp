#include "ebac/rt/shared_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace ebac::rt {

namespace {

[[noreturn]] void refuse(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// Closes a descriptor, and refuses for what went wrong before.
[[noreturn]] void refuse_closing(int descriptor, const char* what) {
  const int error = errno;
  close(descriptor);
  errno = error;
  refuse(what);
}

}  // namespace

SharedMemory::SharedMemory(std::size_t bytes)
    : bytes_(bytes), descriptor_(memfd_create("ebac", MFD_CLOEXEC)) {
  if (descriptor_ < 0) refuse("memory to share");
  if (ftruncate(descriptor_, static_cast<off_t>(bytes)) != 0) {
    refuse_closing(descriptor_, "memory to share");
  }
  map();
}

SharedMemory::SharedMemory(int descriptor, std::size_t bytes)
    : bytes_(bytes), descriptor_(fcntl(descriptor, F_DUPFD_CLOEXEC, 0)) {
  const std::string name = "memory of another process at descriptor " + std::to_string(descriptor);
  if (descriptor_ < 0) refuse(name.c_str());
  struct stat facts{};
  if (fstat(descriptor_, &facts) != 0) refuse_closing(descriptor_, name.c_str());
  if (facts.st_size != static_cast<off_t>(bytes)) {
    close(descriptor_);
    throw std::invalid_argument(name + ": has not the " + std::to_string(bytes) +
                                " bytes expected; both must be of the same version");
  }
  map();
}

SharedMemory::SharedMemory(std::string name, int descriptor, std::size_t bytes)
    : bytes_(bytes), descriptor_(descriptor), name_(std::move(name)), owner_(getpid()) {
  map();
}

SharedMemory SharedMemory::named(const std::string& name, std::size_t bytes) {
  const std::string what = "memory to share as " + name;
  const int descriptor = shm_open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0) refuse(what.c_str());
  if (ftruncate(descriptor, static_cast<off_t>(bytes)) != 0) {
    const int error = errno;
    remove(name);
    errno = error;
    refuse_closing(descriptor, what.c_str());
  }
  return {name, descriptor, bytes};
}

SharedMemory SharedMemory::opened(const std::string& name) {
  const std::string what = "memory that another process shares as " + name;
  const int descriptor = shm_open(name.c_str(), O_RDWR | O_CLOEXEC, 0);
  if (descriptor < 0) refuse(what.c_str());
  struct stat facts{};
  if (fstat(descriptor, &facts) != 0 || facts.st_size <= 0) {
    errno = ENODATA;
    refuse_closing(descriptor, what.c_str());
  }
  return {{}, descriptor, static_cast<std::size_t>(facts.st_size)};
}

void SharedMemory::remove(const std::string& name) noexcept { shm_unlink(name.c_str()); }

void SharedMemory::map() {
  at_ = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
  if (at_ != MAP_FAILED) return;
  const int error = errno;
  close(descriptor_);
  if (!name_.empty()) remove(name_);
  errno = error;
  refuse("memory to share");
}

SharedMemory::~SharedMemory() {
  munmap(at_, bytes_);
  close(descriptor_);
  if (!name_.empty() && getpid() == owner_) remove(name_);
}

}  // namespace ebac::rt
