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

/// Ticks under the law: one for every tick from 0 to the end.
inline std::int64_t tick_count(const Setup& setup) {
  return std::llround(setup.seconds / setup.timing.dt) + 1;
}

/// Rows of a whole run, at most; with those in which the force goes out and the device is stopped.
inline std::size_t row_count(const Setup& setup) {
  const RunPlan& plan = setup.loop.plan;
  const double ramp = plan.ramp_down > 0 ? std::ceil(plan.ramp_down / setup.timing.dt) : 0;
  const std::int64_t end = plan.ticks > 0 ? std::llround(ramp) + 1 + plan.stop_ticks : 0;
  return static_cast<std::size_t>(tick_count(setup) + end);
}

}  // namespace ebac
