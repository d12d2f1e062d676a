#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "ebac/core/timing.hpp"
#include "ebac/loop/loop_options.hpp"
#include "ebac/loop/observer_params.hpp"
#include "ebac/model/device.hpp"
#include "ebac/model/environment.hpp"
#include "ebac/model/hand.hpp"

namespace ebac {

/// Everything of a simulated run but the law. The same setup gives the same bits on every run.
struct Setup {
  DeviceModel device{};
  Hand hand{};
  Environment environment{Wall{}};
  Timing timing{};
  double seconds = 6;  // s
  double jitter = 0;   // of a tick
  std::uint64_t seed = 1;
  LoopOptions loop{};  // soft start and limits; none by default
  std::optional<ObserverParams> observer{};
};

/// Rows of a whole run: one for every tick from 0 to its end.
inline std::size_t row_count(const Setup& setup) {
  return static_cast<std::size_t>(std::llround(setup.seconds / setup.timing.dt)) + 1;
}

}  // namespace ebac
