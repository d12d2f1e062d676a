#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>
#include <variant>

namespace ebac {

enum class Fault : std::uint32_t;

inline constexpr double kAnyLow = -std::numeric_limits<double>::infinity();
inline constexpr double kAnyHigh = std::numeric_limits<double>::infinity();

/// One member of an aggregate, told once: bindings, logs, repr, documentation and range errors read
/// it.
template <class Owner>
struct Field {
  using Member = std::variant<double Owner::*, int Owner::*, bool Owner::*, std::int64_t Owner::*,
                              Fault Owner::*>;
  std::string_view name;
  Member member;
  std::string_view unit;     // "1" for a pure number
  std::string_view meaning;  // one sentence, no full stop
  double low = kAnyLow;      // smallest value allowed
  double high = kAnyHigh;    // largest value allowed
};

/// An aggregate that tells its fields: `static constexpr auto fields()`, an array of Field<T>.
template <class T>
concept Described = requires { T::fields().size(); };

}  // namespace ebac
