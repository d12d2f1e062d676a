#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac {

/// An incremental encoder on the motor shaft, read through a counter that wraps around.
struct Encoder {
  int counts_per_turn = 1024;  // counts, as counted (no quadrature in the paper)
  int counter_bits = 32;       // bits

  double count() const EBAC_RT { return 2 * std::numbers::pi / counts_per_turn; }  // rad, motor
  double counts_per_rad() const EBAC_RT { return counts_per_turn * (0.5 * std::numbers::inv_pi); }

  /// The counter at a motor angle, wrapped to `counter_bits`, signed. Zero lies in the middle of a
  /// count, so that a handle resting at the origin does not toggle.
  std::int64_t read(double angle) const EBAC_RT {
    return wrap(std::llrint(angle * counts_per_rad()));
  }

  /// The unwrapped count nearest to `last` that the counter would show as `raw`.
  std::int64_t unwrap(std::int64_t raw, std::int64_t last) const EBAC_RT {
    const auto way = static_cast<std::uint64_t>(raw) - static_cast<std::uint64_t>(last);
    return last + wrap(static_cast<std::int64_t>(way));
  }

  std::int64_t wrap(std::int64_t counts) const EBAC_RT {
    const int spare = 64 - counter_bits;
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(counts) << spare) >> spare;
  }

  static constexpr auto fields() {
    using F = Field<Encoder>;
    return std::array{
        F{"counts_per_turn", &Encoder::counts_per_turn, "counts",
          "counts per motor turn, after any quadrature", 1, 1 << 26},
        F{"counter_bits", &Encoder::counter_bits, "bits",
          "width of the drive's counter, which wraps", 8, 63},
    };
  }
};

}  // namespace ebac
