#pragma once

#include <array>
#include <concepts>
#include <cstdint>

#include "ebac/core/realtime.hpp"
#include "ebac/core/sample.hpp"

namespace ebac {

struct Command {
  std::array<double, kMaxAxes> current{};  // A, computed in the last tick
  double elapsed = 0;                      // s, since the last exchange; 0 in the first
};

/// Status reported by the force sensor.
enum class SensorStatus : std::uint8_t { kGood, kSaturated, kDisconnected, kError };

struct Reading {
  std::array<std::int64_t, kMaxAxes> counts{};     // raw, as wide as the counter
  std::array<double, kMaxAxes> counts_age{};       // s, since they were latched
  std::array<double, kMaxAxes> current_applied{};  // A, over the interval that ended now
  std::array<double, kMaxAxes> force{};            // N, force sensor at the handle
  double force_age = 0;                            // s, of that force
  SensorStatus force_status = SensorStatus::kGood;
  Fault fault = Fault::kNone;
};

/// Hardware, or a simulation of it. One call, because on a synchronous bus it is one event: send
/// the currents of the last tick, latch the new counts and forces.
template <class D>
concept Device = requires(D device, const Command& command) {
  { device.exchange(command) } noexcept -> std::same_as<Reading>;
};

}  // namespace ebac
