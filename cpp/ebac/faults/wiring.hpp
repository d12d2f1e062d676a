#pragma once

#include <cstddef>
#include <cstdint>

#include "ebac/faults/injected_fault.hpp"
#include "ebac/model/noise.hpp"
#include "ebac/simulated_drives/wiring.hpp"

namespace ebac::faults {

/// Signs and zeros by chance, any of them; none for a counter that wraps around by itself.
inline can::Wiring wiring_of(const InjectedFault& injected) EBAC_RT {
  can::Wiring wiring;
  if (injected.kind == Kind::kEncoderWrap) return wiring;
  Noise random(injected.chance, /*stream=*/8);
  for (std::size_t i = 0; i < kMaxAxes; ++i) {
    const std::uint64_t bits = random.bits();
    wiring.motor[i] = (bits & 1U) != 0 ? 1 : -1;
    wiring.encoder[i] = (bits & 2U) != 0 ? 1 : -1;
    wiring.zero[i] = static_cast<std::int32_t>(bits >> 32U);
  }
  return wiring;
}

}  // namespace ebac::faults
