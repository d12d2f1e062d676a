#pragma once

#include <optional>

#include "ebac/loop/observer_params.hpp"

namespace ebac {

/// What a run does with the observer.
struct Observing {
  bool on = false;    // estimates, in every row
  bool acts = false;  // the world is met where the estimate says, and the law uses it
  ObserverParams params{};
};

/// Whether a law is made for the observer.
template <class Law>
bool made_for_observer(const Law& law) {
  if constexpr (requires { law.observed(); }) return law.observed();
  return false;
}

/// What a run under `law` does with an observer, if it has one.
template <class Law>
Observing observing(const std::optional<ObserverParams>& observer, const Law& law) {
  if (!observer) return {};
  return {.on = true, .acts = observer->every_law || made_for_observer(law), .params = *observer};
}

}  // namespace ebac
