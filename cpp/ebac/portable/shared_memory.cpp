#include "ebac/rt/shared_memory.hpp"

#include "ebac/portable/needs_linux.hpp"

namespace ebac::rt {

SharedMemory::SharedMemory(std::size_t bytes) : bytes_(bytes), descriptor_(-1) {
  need_linux("memory shared with another process");
}
SharedMemory::SharedMemory(int descriptor, std::size_t bytes)
    : bytes_(bytes), descriptor_(descriptor) {
  need_linux("memory shared with another process");
}
SharedMemory SharedMemory::named(const std::string& /*name*/, std::size_t bytes) {
  return SharedMemory(bytes);
}
SharedMemory SharedMemory::opened(const std::string& /*name*/) { return SharedMemory(0); }
SharedMemory::~SharedMemory() = default;
void SharedMemory::remove(const std::string& /*name*/) noexcept {}

}  // namespace ebac::rt
