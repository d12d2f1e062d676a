#include "ebac/loop/retune.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "ebac/core/check.hpp"

namespace ebac {

namespace {

/// Parameters that a law keeps from its start: those of the device, the energy reserve, the way
/// it is measured.
constexpr std::array<std::string_view, 8> kFixedParams{"mass",        "damping", "count",
                                                       "current_lag", "reserve", "observed_reserve",
                                                       "resonance",   "observer"};

}  // namespace

void check_tuning(const Tuning& now, const Tuning& next) {
  for (const FieldRow& field : now.table.rows) {
    if (std::ranges::find(kFixedParams, field.name) == kFixedParams.end()) continue;
    const double before = field.number(now.params);
    const double after = field.number(next.params);
    if (before == after) continue;
    throw std::invalid_argument(std::string(now.name) + "." + std::string(field.name) + " = " +
                                shortest(after) + " " + std::string(field.unit) +
                                ": cannot change from " + shortest(before) +
                                " while the loop runs; stop it first");
  }
  const bool same = now.timing.dt == next.timing.dt && now.timing.delay == next.timing.delay &&
                    now.timing.jitter == next.timing.jitter;
  if (!same) {
    throw std::invalid_argument(std::string(now.name) +
                                ": its timing cannot change while the loop runs; stop it first");
  }
}

void check_retune(const AnyLaw& now, const AnyLaw& next) {
  if (&now.type() != &next.type()) {
    throw std::invalid_argument(std::string(now.type().name) + ": cannot become " +
                                std::string(next.type().name) +
                                " while the loop runs; stop it first");
  }
  if (!now.type().tunable) {
    throw std::invalid_argument(
        std::string(now.type().name) +
        ": its parameters cannot change while the loop runs, as the law has "
        "no `retune`; stop it first");
  }
  const auto tuning = [](const AnyLaw& law) -> Tuning {
    return {law.type().name, law.type().params, law.params(), law.timing()};
  };
  check_tuning(tuning(now), tuning(next));
}

}  // namespace ebac
