#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>

#include "ebac/core/realtime.hpp"

namespace ebac::can {

/// One classical CAN frame (ISO 11898-1), as it stands on the wire.
struct Frame {
  static constexpr std::size_t kMaxSize = 8;

  std::uint32_t id = 0;    // 11 bits, or 29 when extended
  std::uint8_t size = 0;   // bytes of data, 0 to 8
  bool extended = false;   // 29-bit identifier
  bool remote = false;     // remote frame: requests data, carries none
  bool error = false;      // error frame of the controller, not of another node
  std::int64_t stamp = 0;  // ns, when it was received; 0 where the bus does not know
  std::array<std::uint8_t, kMaxSize> data{};
  bool own = false;  // the receiving end sent it and has `own` switched on

  constexpr std::span<const std::uint8_t> bytes() const EBAC_RT {
    return {data.data(), size < kMaxSize ? size : kMaxSize};
  }

  /// Equal up to the time stamp and the sender.
  friend constexpr bool operator==(const Frame& a, const Frame& b) EBAC_RT {
    return a.id == b.id && a.size == b.size && a.extended == b.extended && a.remote == b.remote &&
           a.error == b.error && a.data == b.data;
  }
};

inline constexpr std::uint32_t kStandardIds = 0x7FF;
inline constexpr std::uint32_t kExtendedIds = 0x1FFF'FFFF;

/// Whether a controller could put it on the wire.
constexpr bool sendable(const Frame& out) EBAC_RT {
  return out.size <= Frame::kMaxSize && out.id <= (out.extended ? kExtendedIds : kStandardIds);
}

constexpr Frame frame(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) EBAC_RT {
  Frame made{.id = id};
  for (const std::uint8_t byte : bytes) {
    if (made.size < Frame::kMaxSize) made.data[made.size++] = byte;
  }
  return made;
}

/// Little-endian, as every number of CANopen (CiA 301, 7.1.4). Bytes outside the frame read as 0.
template <class T>
constexpr T get(std::span<const std::uint8_t> bytes, std::size_t at) EBAC_RT {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    if (at + i < bytes.size()) value |= std::uint64_t{bytes[at + i]} << (8 * i);
  }
  return static_cast<T>(value);
}

template <class T>
constexpr void put(std::span<std::uint8_t> bytes, std::size_t at, T value) EBAC_RT {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    if (at + i < bytes.size()) {
      bytes[at + i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
    }
  }
}

}  // namespace ebac::can
