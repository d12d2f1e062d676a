#pragma once

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

#include "ebac/core/check.hpp"
#include "ebac/core/concepts.hpp"

namespace ebac {

/// A law whose gains may change while it runs: `retune(next)` takes the parameters of `next` and
/// keeps its memory.
template <class L>
concept Tunable = Controller<L> && requires(L law, const L& next) {
  { law.retune(next) } noexcept;
};

/// What a law knows of the device, and what it holds in reserve: it keeps them from its start.
inline constexpr std::array<std::string_view, 5> kFixedParams{"mass", "damping", "count",
                                                              "current_lag", "reserve"};

/// Throws std::invalid_argument when `next` is no retuning of `now`, naming what may not change.
template <Tunable Law>
void check_retune(const Law& now, const Law& next) {
  using Params = Law::Params;
  for (const auto& field : Params::fields()) {
    if (std::ranges::find(kFixedParams, field.name) == kFixedParams.end()) continue;
    const auto member = std::get<double Params::*>(field.member);
    if (now.params().*member == next.params().*member) continue;
    throw std::invalid_argument(std::string(Law::kName) + "." + std::string(field.name) + " = " +
                                shortest(next.params().*member) + " " + std::string(field.unit) +
                                ": cannot change from " + shortest(now.params().*member) +
                                " while the loop runs; stop it first");
  }
  const bool same = now.timing().dt == next.timing().dt &&
                    now.timing().delay == next.timing().delay &&
                    now.timing().jitter == next.timing().jitter;
  if (!same) {
    throw std::invalid_argument(std::string(Law::kName) +
                                ": its timing cannot change while the loop runs; stop it first");
  }
}

}  // namespace ebac
