#pragma once

#include <cstddef>

namespace ebac::rt {

/// A few bytes that several processes see, by a file that has no name.
class SharedMemory {
 public:
  /// New, all zero. Throws std::system_error when the system has none.
  explicit SharedMemory(std::size_t bytes);
  /// That of another process, by the descriptor it handed down, which stays the caller's. Throws
  /// std::invalid_argument when it is something else, std::system_error when it cannot be had.
  SharedMemory(int descriptor, std::size_t bytes);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  SharedMemory(SharedMemory&&) = delete;
  SharedMemory& operator=(SharedMemory&&) = delete;

  void* at() const noexcept { return at_; }
  /// For a process started from here: it is not handed down unasked.
  int descriptor() const noexcept { return descriptor_; }

 private:
  void map();

  std::size_t bytes_;
  int descriptor_;
  void* at_ = nullptr;
};

}  // namespace ebac::rt
