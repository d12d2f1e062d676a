#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "ebac/core/realtime.hpp"

namespace ebac::can {

/// A bounded queue for any number of producers and consumers: no lock, no allocation after
/// construction. Every slot counts its turns, even when free and odd when filled; the thread that
/// moves `tail_` or `head_` past a slot owns it for one turn (bounded MPMC queue of D. Vyukov,
/// 2010).
template <class Item>
class MpmcQueue {
 public:
  explicit MpmcQueue(std::size_t capacity)
      : capacity_(capacity), slots_(std::make_unique<Slot[]>(capacity)) {}

  std::size_t capacity() const EBAC_RT { return capacity_; }

  /// False when it is full.
  bool push(const Item& item) EBAC_RT {
    std::uint64_t at = tail_.load(std::memory_order_relaxed);
    for (;;) {
      Slot& slot = slots_[at % capacity_];
      const std::uint64_t free = 2 * (at / capacity_);
      if (slot.turn.load(std::memory_order_acquire) == free) {
        if (tail_.compare_exchange_weak(at, at + 1, std::memory_order_relaxed)) {
          slot.item = item;
          slot.turn.store(free + 1, std::memory_order_release);
          return true;
        }
        continue;  // another was quicker, and `at` is the tail it left
      }
      const std::uint64_t before = at;
      at = tail_.load(std::memory_order_relaxed);
      if (at == before) return false;
    }
  }

  /// False when nothing is ready.
  bool pop(Item& item) EBAC_RT {
    std::uint64_t at = head_.load(std::memory_order_relaxed);
    for (;;) {
      Slot& slot = slots_[at % capacity_];
      const std::uint64_t filled = 2 * (at / capacity_) + 1;
      if (slot.turn.load(std::memory_order_acquire) == filled) {
        if (head_.compare_exchange_weak(at, at + 1, std::memory_order_relaxed)) {
          item = slot.item;
          slot.turn.store(filled + 1, std::memory_order_release);
          return true;
        }
        continue;
      }
      const std::uint64_t before = at;
      at = head_.load(std::memory_order_relaxed);
      if (at == before) return false;
    }
  }

  /// Whether `pop` would succeed now, if this is the only consumer.
  bool ready() const EBAC_RT {
    const std::uint64_t at = head_.load(std::memory_order_relaxed);
    return slots_[at % capacity_].turn.load(std::memory_order_acquire) == 2 * (at / capacity_) + 1;
  }

 private:
  struct Slot {
    std::atomic<std::uint64_t> turn{0};
    Item item{};
  };
  static constexpr std::size_t kLine = 64;  // bytes, so that both sides do not share a cache line

  std::size_t capacity_;
  std::unique_ptr<Slot[]> slots_;
  alignas(kLine) std::atomic<std::uint64_t> tail_{0};
  alignas(kLine) std::atomic<std::uint64_t> head_{0};
};

}  // namespace ebac::can
