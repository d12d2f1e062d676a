#pragma once

#include <concepts>
#include <string_view>

#include "ebac/core/check.hpp"
#include "ebac/core/device_facts.hpp"
#include "ebac/core/fields.hpp"
#include "ebac/core/sample.hpp"
#include "ebac/core/timing.hpp"

namespace ebac {

/// A law for one port: a cheap, copyable value. Parameters are checked by the constructor, which
/// may throw; `step` runs inside the tick.
template <class L>
concept Controller =
    std::copyable<L> && Described<typename L::Params> && Described<typename L::State> &&
    std::constructible_from<L, typename L::Params, Timing> &&
    requires(L law, const L& view, const Port& port, const DeviceFacts& facts, Timing timing) {
      { L::kName } -> std::convertible_to<std::string_view>;
      { L::kSummary } -> std::convertible_to<std::string_view>;
      { L::Params::design(facts, timing) } -> std::same_as<typename L::Params>;
      { law.step(port) } noexcept -> std::same_as<double>;
      { law.reset() } noexcept;
      { view.state() } noexcept -> std::same_as<const typename L::State&>;
      { view.params() } noexcept -> std::same_as<const typename L::Params&>;
      { view.timing() } noexcept -> std::same_as<const Timing&>;
    };

/// How long the energy account of a law has held its force back [s]; 0 for a law without one.
template <class L>
double starved_of(const L& law) EBAC_RT {
  if constexpr (requires { law.starved(); }) return law.starved();
  return 0;
}

/// Whether the energy account of a law is low with the observer; false for a law without one.
template <class L>
bool drained_of(const L& law) EBAC_RT {
  if constexpr (requires { law.drained(); }) return law.drained();
  return false;
}

/// Whether a law uses the observer's estimate where a run has one.
template <class L>
bool observed_of(const L& law) EBAC_RT {
  if constexpr (requires { law.observed(); }) return law.observed();
  return false;
}

}  // namespace ebac
