#pragma once

#include <cstdint>

#include "ebac/core/realtime.hpp"

/// The pre-defined connection set (CiA 301, 7.3.5): identifiers of the services.
namespace ebac::can {

using NodeId = std::uint8_t;  // 1 to 127
inline constexpr NodeId kLastNode = 127;

inline constexpr std::uint32_t kNmt = 0x000;
inline constexpr std::uint32_t kSync = 0x080;

// Of a COB-ID in the object dictionary (CiA 301, 7.5.2.33).
inline constexpr std::int64_t kInvalid = 1LL << 31;
inline constexpr std::int64_t kNoRemote = 1LL << 30;

constexpr std::uint32_t emcy(NodeId node) EBAC_RT { return 0x080U + node; }
/// `number` 1 to 4, from the node.
constexpr std::uint32_t tpdo(int number, NodeId node) EBAC_RT {
  return 0x080U + 0x100U * static_cast<std::uint32_t>(number) + node;
}
/// `number` 1 to 4, to the node.
constexpr std::uint32_t rpdo(int number, NodeId node) EBAC_RT {
  return 0x100U + 0x100U * static_cast<std::uint32_t>(number) + node;
}
constexpr std::uint32_t sdo_answer(NodeId node) EBAC_RT { return 0x580U + node; }
constexpr std::uint32_t sdo_request(NodeId node) EBAC_RT { return 0x600U + node; }
constexpr std::uint32_t heartbeat(NodeId node) EBAC_RT { return 0x700U + node; }

}  // namespace ebac::can
