#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac {

/// Parameters that a law keeps from its start: those of device and sensor, the energy reserve, the
/// way it is measured. All others are gains, which may change while it runs.
constexpr std::array<std::string_view, 9> kFixedParams{
    "mass",    "damping",          "count",     "current_lag", "force_noise",
    "reserve", "observed_reserve", "resonance", "observer"};

/// The first fixed parameter that differs between two laws of one type, or nullptr.
inline const FieldRow* fixed_change(const FieldTable& table, const void* now,
                                    const void* next) EBAC_RT {
  const auto found = std::ranges::find_if(table.rows, [&](const FieldRow& field) EBAC_RT {
    return std::ranges::find(kFixedParams, field.name) != kFixedParams.end() &&
           field.number(now) != field.number(next);
  });
  return found == table.rows.end() ? nullptr : &*found;
}

}  // namespace ebac
