#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ebac/core/realtime.hpp"

/// Packets of the ATI Net F/T and of sensors that speak like it ("RDT", over UDP). Everything on the
/// wire is big endian.
namespace ebac::sensor {

/// Commands of a client.
enum class RdtCommand : std::uint16_t {
  kStop = 0,
  kStart = 2,          // one record a packet
  kStartBuffered = 3,  // several records a packet
  kBias = 0x42,        // the present load becomes zero
};

struct RdtRequest {
  static constexpr std::uint16_t kHeader = 0x1234;
  static constexpr std::size_t kBytes = 8;

  std::uint16_t command = 0;
  std::uint32_t samples = 0;  // records wanted; 0 for no end

  bool operator==(const RdtRequest&) const = default;
};

struct RdtRecord {
  static constexpr std::size_t kBytes = 36;

  std::uint32_t rdt_sequence = 0;        // of the records sent to this client
  std::uint32_t ft_sequence = 0;         // of the samples taken inside the sensor
  std::uint32_t status = 0;              // bits, by the model
  std::array<std::int32_t, 3> force{};   // counts
  std::array<std::int32_t, 3> torque{};  // counts

  bool operator==(const RdtRecord&) const = default;
};

namespace wire {

inline void put(std::span<std::uint8_t> bytes, std::size_t at, std::uint32_t value,
                std::size_t width = 4) EBAC_RT {
  for (std::size_t i = 0; i < width; ++i) {
    bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * (width - 1 - i)));
  }
}

inline std::uint32_t get(std::span<const std::uint8_t> bytes, std::size_t at,
                         std::size_t width = 4) EBAC_RT {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < width; ++i) value = value << 8 | bytes[at + i];
  return value;
}

}  // namespace wire

inline std::array<std::uint8_t, RdtRequest::kBytes> encode(const RdtRequest& request) EBAC_RT {
  std::array<std::uint8_t, RdtRequest::kBytes> bytes{};
  wire::put(bytes, 0, RdtRequest::kHeader, 2);
  wire::put(bytes, 2, request.command, 2);
  wire::put(bytes, 4, request.samples);
  return bytes;
}

inline std::array<std::uint8_t, RdtRecord::kBytes> encode(const RdtRecord& record) EBAC_RT {
  std::array<std::uint8_t, RdtRecord::kBytes> bytes{};
  wire::put(bytes, 0, record.rdt_sequence);
  wire::put(bytes, 4, record.ft_sequence);
  wire::put(bytes, 8, record.status);
  for (std::size_t i = 0; i < 3; ++i) {
    wire::put(bytes, 12 + 4 * i, static_cast<std::uint32_t>(record.force[i]));
    wire::put(bytes, 24 + 4 * i, static_cast<std::uint32_t>(record.torque[i]));
  }
  return bytes;
}

/// False where the bytes are no request: another length, another header.
inline bool decode(std::span<const std::uint8_t> bytes, RdtRequest& request) EBAC_RT {
  if (bytes.size() != RdtRequest::kBytes || wire::get(bytes, 0, 2) != RdtRequest::kHeader) {
    return false;
  }
  request.command = static_cast<std::uint16_t>(wire::get(bytes, 2, 2));
  request.samples = wire::get(bytes, 4);
  return true;
}

/// False where the bytes are not as many as a record has.
inline bool decode(std::span<const std::uint8_t> bytes, RdtRecord& record) EBAC_RT {
  if (bytes.size() != RdtRecord::kBytes) return false;
  record.rdt_sequence = wire::get(bytes, 0);
  record.ft_sequence = wire::get(bytes, 4);
  record.status = wire::get(bytes, 8);
  for (std::size_t i = 0; i < 3; ++i) {
    record.force[i] = static_cast<std::int32_t>(wire::get(bytes, 12 + 4 * i));
    record.torque[i] = static_cast<std::int32_t>(wire::get(bytes, 24 + 4 * i));
  }
  return true;
}

}  // namespace ebac::sensor
