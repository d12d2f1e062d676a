#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
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

/// What was just written is copied a word at a time: a vector of two such words waits until they have left the store
/// queue.
template <class T>
void copy_words(std::byte* to, const T& from) EBAC_RT {
  constexpr std::size_t kWord = sizeof(std::uint64_t);
  static_assert(sizeof(T) % kWord == 0);
  const auto* words = reinterpret_cast<const std::byte*>(&from);
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (std::memcpy(to + I * kWord, words + I * kWord, kWord), ...);
  }(std::make_index_sequence<sizeof(T) / kWord>());
}

/// The states of a part into its columns, one axis after the other.
template <class Part>
void copy_states(std::byte* row, const Part& part, std::size_t axes) EBAC_RT {
  using State = Part::State;
  if constexpr (State::fields().size() > 0) {
    for (std::size_t i = 0; i < axes; ++i) {
      std::memcpy(row + i * sizeof(State), &part.state(i), sizeof(State));
    }
  }
}

}  // namespace ebac
