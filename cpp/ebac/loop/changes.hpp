#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "ebac/core/realtime.hpp"

namespace ebac {

enum class ChangeOf : std::uint32_t { kLaw = 1, kEnvironment = 2, kTarget = 3 };

/// A value that the loop took while it ran.
struct Change {
  std::int64_t tick = 0;     // from which it acts
  std::uint64_t serial = 0;  // of the value, as its writer numbers them
  ChangeOf what = ChangeOf::kLaw;
};

/// The changes of a run, beside its trace: written by the loop, read by anyone while it grows.
class Changes {
 public:
  static constexpr std::size_t kMost = 4096;

  void add(const Change& change) EBAC_RT {
    const std::size_t n = count_.load(std::memory_order_relaxed);
    if (n == kMost) {
      lost_.store(lost_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return;
    }
    all_[n] = change;
    count_.store(n + 1, std::memory_order_release);
  }

  std::size_t size() const EBAC_RT { return count_.load(std::memory_order_acquire); }
  const Change& operator[](std::size_t i) const EBAC_RT { return all_[i]; }
  /// Changes that acted, but found no room here.
  std::size_t lost() const EBAC_RT { return lost_.load(std::memory_order_relaxed); }

 private:
  std::array<Change, kMost> all_{};
  std::atomic<std::size_t> count_{0};
  std::atomic<std::size_t> lost_{0};
};

}  // namespace ebac
