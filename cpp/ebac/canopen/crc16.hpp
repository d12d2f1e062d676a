#pragma once

#include <cstdint>
#include <span>

#include "ebac/core/realtime.hpp"

namespace ebac::can {

/// CRC-16-CCITT as CiA 301 has it: polynomial 0x1021, from 0.
inline std::uint16_t crc16(std::span<const std::uint8_t> bytes) EBAC_RT {
  unsigned crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc ^= static_cast<unsigned>(byte) << 8U;
    for (int bit = 0; bit < 8; ++bit) {
      crc = ((crc << 1U) ^ ((crc & 0x8000U) != 0 ? 0x1021U : 0U)) & 0xFFFFU;
    }
  }
  return static_cast<std::uint16_t>(crc);
}

}  // namespace ebac::can
