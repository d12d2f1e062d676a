#pragma once

#include <cstddef>
#include <tuple>
#include <utility>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// The parts of a device that have columns in a trace. Each part has a State with fields, a
/// `kPrefix` for the names of its columns, and `state(axis)`. A device made of several devices
/// lists them by `parts()`, a tuple of references; a device with a State is its own only part; any
/// other has none.
template <class D>
auto row_parts(const D& device) EBAC_RT {
  if constexpr (requires { device.parts(); }) {
    return device.parts();
  } else if constexpr (requires { typename D::State; }) {
    return std::tie(device);
  } else {
    return std::tuple<>{};
  }
}

template <class D>
inline constexpr std::size_t kRowParts =
    std::tuple_size_v<decltype(row_parts(std::declval<const D&>()))>;

}  // namespace ebac
