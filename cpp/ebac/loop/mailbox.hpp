#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <concepts>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Passes the newest value from one writer to one reader without waiting. A value replaced before
/// it was taken is lost on purpose. Three slots: one is the writer's, one the reader's, and the
/// third changes hands. In memory shared with another process its indices may become anything: the values are then
/// nonsense, but lie within.
template <std::copyable T>
class Mailbox {
 public:
  /// `initial` only fills the slots; there is nothing to take until `post`.
  explicit Mailbox(const T& initial = {}) : places_{initial, initial, initial} {}

  /// Writer. A value whose copy may throw is moved, or its copy would end the process.
  void post(T value) EBAC_RT {
    static_assert(std::is_nothrow_move_assignable_v<T>);
    const std::uint32_t mine = within(writers_);
    places_[mine] = std::move(value);
    writers_ = within(shared_.exchange(mine | kNew, std::memory_order_acq_rel));
  }

  /// Reader: the newest value not taken yet, or nullptr. It is the reader's until the next call; what the reader leaves
  /// in it is freed by the writer.
  T* take() EBAC_RT {
    if ((shared_.load(std::memory_order_relaxed) & kNew) == 0) return nullptr;
    const std::uint32_t mine =
        within(shared_.exchange(within(readers_), std::memory_order_acq_rel));
    readers_ = mine;
    return &places_[mine];
  }

 private:
  static constexpr std::uint32_t kPlace = 3;
  static constexpr std::uint32_t kNew = 4;

  static constexpr std::uint32_t within(std::uint32_t index) EBAC_RT {
    return std::min(index & kPlace, std::uint32_t{2});
  }

  std::array<T, 3> places_;
  std::uint32_t writers_ = 0;
  std::uint32_t readers_ = 1;
  std::atomic<std::uint32_t> shared_{2};
};

}  // namespace ebac
