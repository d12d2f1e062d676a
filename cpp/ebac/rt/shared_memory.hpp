#pragma once

#include <cstddef>
#include <string>

namespace ebac::rt {

/// A few bytes that several processes see: by a file that has no name, or by a name of the system's.
class SharedMemory {
 public:
  /// New, all zero. Throws std::system_error when the system has none.
  explicit SharedMemory(std::size_t bytes);
  /// That of another process, by the descriptor it handed down, which stays the caller's. Throws
  /// std::invalid_argument when it is something else, std::system_error when it cannot be had.
  SharedMemory(int descriptor, std::size_t bytes);
  /// New, all zero, under a name as "/it", for this user alone; the name goes with this object. Throws std::system_error,
  /// with EEXIST where there is something of that name.
  static SharedMemory named(const std::string& name, std::size_t bytes);
  /// What another process made under that name, as large as it is. Throws std::system_error when there is nothing.
  static SharedMemory opened(const std::string& name);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  SharedMemory(SharedMemory&&) = delete;
  SharedMemory& operator=(SharedMemory&&) = delete;

  void* at() const noexcept { return at_; }
  std::size_t bytes() const noexcept { return bytes_; }
  /// For a process started from here: it is not handed down unasked.
  int descriptor() const noexcept { return descriptor_; }
  /// Takes the name away, whoever made it: who has the memory keeps it, nobody else finds it.
  static void remove(const std::string& name) noexcept;

 private:
  /// Of a descriptor that is its own from now on.
  SharedMemory(std::string name, int descriptor, std::size_t bytes);
  void map();

  std::size_t bytes_;
  int descriptor_;
  std::string name_;  // that it takes away; empty for none
  int owner_;         // process that made it: a forked one leaves the name to it
  void* at_ = nullptr;
};

}  // namespace ebac::rt
