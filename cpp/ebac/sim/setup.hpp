#pragma once

#include <cstdint>
#include <optional>

#include "ebac/core/timing.hpp"
#include "ebac/loop/loop.hpp"
#include "ebac/loop/observer.hpp"
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

  /// What a run under `law` does with the observer.
  template <class Law>
  Observing observing(const Law& law) const {
    if (!observer) return {};
    return {.on = true, .acts = observer->every_law || made_for_observer(law), .params = *observer};
  }
};

}  // namespace ebac
