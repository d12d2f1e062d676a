#pragma once

#include <optional>

#include "ebac/core/controller.hpp"
#include "ebac/loop/observer_params.hpp"

namespace ebac {

/// What a run does with the observer.
struct Observing {
  bool on = false;    // estimates, in every row
  bool acts = false;  // the world is met where the estimate says, and the law uses it
  ObserverParams params{};
};

/// What a run under `law` does with an observer, if it has one.
template <class Law>
Observing observing(const std::optional<ObserverParams>& observer, const Law& law) {
  if (!observer) return {};
  return {.on = true, .acts = observer->every_law || observed_of(law), .params = *observer};
}

}  // namespace ebac
