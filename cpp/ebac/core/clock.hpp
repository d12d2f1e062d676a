#pragma once

#include <concepts>
#include <cstdint>

namespace ebac {

struct Instant {
  double t = 0;              // s, since the start
  double dt = 0;             // s, since the last tick; 0 in the first
  double lateness = 0;       // s
  std::int64_t skipped = 0;  // ticks before this one that could not be kept
};

/// Clock of a loop.
template <class C>
concept Clock = requires(C clock) {
  { clock.wait() } noexcept -> std::same_as<Instant>;
};

}  // namespace ebac
