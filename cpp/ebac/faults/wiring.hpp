#pragma once

#include <array>
#include <cstdint>

#include "ebac/faults/injected_fault.hpp"
#include "ebac/model/noise.hpp"

namespace ebac::faults {

/// How motors and encoders are wired, and where the encoders have their zero.
struct Wiring {
  std::array<int, kMaxAxes> motor_sign{1, 1, 1};
  std::array<int, kMaxAxes> encoder_sign{1, 1, 1};
  std::array<std::int32_t, kMaxAxes> encoder_zero{};  // counts
};

/// Any, but for a counter that wraps around by itself.
inline Wiring wiring_of(const InjectedFault& injected) EBAC_RT {
  Wiring wiring;
  if (injected.kind == Kind::kEncoderWrap) return wiring;
  Noise random(injected.chance, /*stream=*/8);
  for (std::size_t i = 0; i < kMaxAxes; ++i) {
    const std::uint64_t bits = random.bits();
    wiring.motor_sign[i] = (bits & 1U) != 0 ? 1 : -1;
    wiring.encoder_sign[i] = (bits & 2U) != 0 ? 1 : -1;
    wiring.encoder_zero[i] = static_cast<std::int32_t>(bits >> 32U);
  }
  return wiring;
}

}  // namespace ebac::faults
