#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <new>
#include <utility>

#include "ebac/loop/device_around.hpp"
#include "ebac/loop/parameter_updates.hpp"
#include "ebac/rt/shared_memory.hpp"

namespace ebac::rt {

/// Target of a simulated hand, shared between a loop and the simulation of the hand in another
/// thread or another process. One writer, one reader; neither waits.
class SharedHandTarget {
 public:
  /// Throws as SharedMemory.
  SharedHandTarget() : memory_(sizeof(Cell)), cell_(new (memory_.at()) Cell()) {}
  /// The target shared by the process that passed `descriptor` on. Throws as SharedMemory.
  explicit SharedHandTarget(int descriptor)
      : memory_(descriptor, sizeof(Cell)), cell_(static_cast<Cell*>(memory_.at())) {}

  void post(const HandTarget& aim) EBAC_RT { cell_->post(aim); }
  const HandTarget* take() EBAC_RT { return cell_->take(); }
  int descriptor() const noexcept { return memory_.descriptor(); }

 private:
  using Cell = Mailbox<HandTarget>;
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free, "or it is not for two processes");

  SharedMemory memory_;
  Cell* cell_;
};

/// A simulated device whose hand follows a shared target, if there is one. Copies share it.
template <Device D>
class TargetSubscriber : public DeviceAround<D> {
  using DeviceAround<D>::device_;

 public:
  explicit TargetSubscriber(D device, std::shared_ptr<SharedHandTarget> cell = nullptr)
      : DeviceAround<D>(std::move(device)), cell_(std::move(cell)) {}

  Reading exchange(const Command& command) EBAC_RT {
    // A reading without elapsed time takes no target.
    if (cell_ != nullptr && command.elapsed > 0) follow(cell_->take());
    return device_.exchange(command);
  }

 private:
  void follow(const HandTarget* aim) EBAC_RT {
    if (aim == nullptr) return;
    for (std::size_t i = 0; i < kMaxAxes; ++i) {
      if (std::isfinite(aim->target[i])) device_.aim(i, aim->target[i]);
    }
  }

  std::shared_ptr<SharedHandTarget> cell_;
};

/// A device of a loop whose hand is simulated elsewhere: passes new targets on with the next
/// exchange, if there is a shared target.
template <Device D>
class TargetPublisher : public DeviceAround<D> {
  using DeviceAround<D>::device_;

 public:
  explicit TargetPublisher(D device, std::shared_ptr<SharedHandTarget> cell = nullptr)
      : DeviceAround<D>(std::move(device)), cell_(std::move(cell)) {}

  Reading exchange(const Command& command) EBAC_RT {
    if (new_ && cell_ != nullptr) cell_->post(aim_);
    new_ = false;
    return device_.exchange(command);
  }
  /// A target that is not finite leaves the hand of this axis unchanged.
  void aim(std::size_t axis, double target) EBAC_RT {
    aim_.target[axis] = target;
    new_ = true;
  }

 private:
  std::shared_ptr<SharedHandTarget> cell_;
  HandTarget aim_;
  bool new_ = false;
};

}  // namespace ebac::rt
