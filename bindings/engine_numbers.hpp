#pragma once

#include <optional>
#include <tuple>

#include "ebac/world/engine/local_model.hpp"

namespace ebac::python {

/// A local model as Python gives it: place, normal, curvature, stiffness, damping, velocity.
using ModelNumbers = std::tuple<Axes, Axes, double, double, double, Axes>;

inline world::LocalModel model_of(const std::optional<ModelNumbers>& given, double t) {
  if (!given) return {.t = t};
  const auto& [at, into, curvature, stiffness, damping, velocity] = *given;
  return {.at = at,
          .into = into,
          .curvature = curvature,
          .stiffness = stiffness,
          .damping = damping,
          .velocity = velocity,
          .t = t,
          .surface = true};
}

}  // namespace ebac::python
