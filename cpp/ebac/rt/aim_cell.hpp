#pragma once

#include <atomic>
#include <cstdint>
#include <new>

#include "ebac/loop/mail.hpp"
#include "ebac/rt/shared_memory.hpp"

namespace ebac::rt {

/// Where a simulated hand should go: from a loop to who simulates the hand, in another thread or in
/// another process. One writer, one reader, neither of which ever waits.
class AimCell {
 public:
  /// Throws as SharedMemory.
  AimCell() : memory_(sizeof(Cell)), cell_(new (memory_.at()) Cell()) {}
  /// The same cell as in the process that handed `descriptor` down. Throws as SharedMemory.
  explicit AimCell(int descriptor)
      : memory_(descriptor, sizeof(Cell)), cell_(static_cast<Cell*>(memory_.at())) {}

  void post(const Aim& aim) EBAC_RT { cell_->post(aim); }
  const Aim* take() EBAC_RT { return cell_->take(); }
  int descriptor() const noexcept { return memory_.descriptor(); }

 private:
  using Cell = Mailbox<Aim>;
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free, "or it is not for two processes");

  SharedMemory memory_;
  Cell* cell_;
};

}  // namespace ebac::rt
