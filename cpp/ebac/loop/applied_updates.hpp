#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "ebac/core/realtime.hpp"

namespace ebac {

enum class UpdateOf : std::uint32_t { kLaw, kEnvironment, kTarget, kDelay };

/// A parameter update that a running loop applied.
struct AppliedUpdate {
  std::int64_t tick = 0;     // first tick with the new value
  std::uint64_t serial = 0;  // number given by the writer
  UpdateOf what = UpdateOf::kLaw;
};

/// The updates applied in a run, beside its trace: written by the loop, read by one thread at a time. Up to 4096
/// that were not read are kept.
class AppliedUpdates {
 public:
  static constexpr std::size_t kMost = 4096;

  void add(const AppliedUpdate& change) EBAC_RT {
    const std::size_t n = count_.load(std::memory_order_relaxed);
    if (n - read_.load(std::memory_order_acquire) == kMost) {
      lost_.store(lost_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return;
    }
    all_[n % kMost] = change;
    count_.store(n + 1, std::memory_order_release);
  }

  std::size_t size() const EBAC_RT { return count_.load(std::memory_order_acquire); }
  const AppliedUpdate& operator[](std::size_t i) const EBAC_RT { return all_[i % kMost]; }
  /// All before number `i` were read: their places are used again. Reader.
  void read(std::size_t i) EBAC_RT {
    read_.store(std::clamp(i, first(), size()), std::memory_order_release);
  }
  /// Number of the first that was not read. Reader.
  std::size_t first() const EBAC_RT { return read_.load(std::memory_order_relaxed); }
  /// Updates that were applied but not recorded, because nobody read those before.
  std::size_t lost() const EBAC_RT { return lost_.load(std::memory_order_relaxed); }

 private:
  std::array<AppliedUpdate, kMost> all_{};
  std::atomic<std::size_t> count_{0};
  std::atomic<std::size_t> read_{0};
  std::atomic<std::size_t> lost_{0};
};

}  // namespace ebac
