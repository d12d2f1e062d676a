#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "ebac/core/device.hpp"

namespace ebac::sensor {

/// Whose status bits a record carries.
enum class SensorModel : std::uint8_t { kNetFt, kAxia, kOther };

/// Meaning of the status bits. Sources: ATI's manuals of the Net F/T (9620-05-NET FT, system status
/// code) and of the Ethernet Axia (9610-05, table 4.7).
struct StatusBits {
  std::uint32_t saturated = 0;  // more than the sensor can measure
  std::uint32_t harmless = 0;   // no word about the force

  static constexpr std::uint32_t kAnyError = 1U << 31U;

  static constexpr StatusBits of(SensorModel model) EBAC_RT {
    switch (model) {
      case SensorModel::kNetFt:  // 17 saturation or converter; 16 a monitor condition was met
        return {.saturated = 1U << 17U, .harmless = 1U << 16U};
      case SensorModel::kAxia:  // 30 force, 27 gage out of range; 3 busy, 16 monitor, 28 simulated
        return {.saturated = 1U << 30U | 1U << 27U, .harmless = 1U << 3U | 1U << 16U | 1U << 28U};
      case SensorModel::kOther:
        break;
    }
    return {};
  }

  constexpr SensorStatus judge(std::uint32_t status) const EBAC_RT {
    const std::uint32_t active = status & ~harmless;
    if (active == 0) return SensorStatus::kGood;
    const std::uint32_t rest = active & ~saturated & ~kAnyError;
    return rest == 0 && (active & saturated) != 0 ? SensorStatus::kSaturated : SensorStatus::kError;
  }
};

}  // namespace ebac::sensor
