#include "ebac/teleop/packet.hpp"

#include <bit>
#include <cmath>

namespace ebac::teleop {

namespace {

constexpr std::uint8_t kSlave = 1;
constexpr std::uint8_t kLost = 2;
constexpr std::uint8_t kLeaving = 4;
constexpr std::uint8_t kScheme = 8;
constexpr std::uint8_t kSchemes = 3;
constexpr std::size_t kMoreAt = 56;
constexpr std::size_t kPlaceAt = 80;
constexpr std::size_t kCrcAt = Packet::kSize - 4;

constexpr std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1U) != 0 ? 0xEDB88320U ^ (c >> 1) : c >> 1;
    table[i] = c;
  }
  return table;
}

template <std::size_t N>
void put(Packet::Wire& wire, std::size_t at, std::uint64_t value) EBAC_RT {
  for (std::size_t i = 0; i < N; ++i) wire[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

template <std::size_t N>
std::uint64_t get(std::span<const std::uint8_t> bytes, std::size_t at) EBAC_RT {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < N; ++i) value |= std::uint64_t{bytes[at + i]} << (8 * i);
  return value;
}

double number(std::span<const std::uint8_t> bytes, std::size_t at) EBAC_RT {
  return std::bit_cast<double>(get<8>(bytes, at));
}

}  // namespace

std::uint32_t crc32(std::span<const std::uint8_t> bytes) EBAC_RT {
  static constexpr auto kTable = crc_table();
  std::uint32_t c = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) c = kTable[(c ^ byte) & 0xFFU] ^ (c >> 8);
  return ~c;
}

Packet::Wire encode(const Packet& packet) EBAC_RT {
  Packet::Wire wire{};
  wire[0] = 'E';
  wire[1] = 'T';
  wire[2] = Packet::kVersion;
  wire[3] = static_cast<std::uint8_t>((packet.from_slave ? kSlave : 0) | (packet.lost ? kLost : 0) |
                                      (packet.leaving ? kLeaving : 0) | (kScheme * packet.scheme));
  put<4>(wire, 4, packet.session);
  put<4>(wire, 8, packet.sequence);
  put<4>(wire, 12, packet.echo);
  put<8>(wire, 16, static_cast<std::uint64_t>(packet.stamp));
  put<8>(wire, 24, std::bit_cast<std::uint64_t>(packet.value));
  put<8>(wire, 32, std::bit_cast<std::uint64_t>(packet.energy));
  put<8>(wire, 40, std::bit_cast<std::uint64_t>(packet.wave));
  put<4>(wire, 48, packet.run);
  put<4>(wire, 52, packet.fault);
  for (std::size_t i = 0; i < packet.more.size(); ++i) {
    put<8>(wire, kMoreAt + 8 * i, std::bit_cast<std::uint64_t>(packet.more[i]));
  }
  for (std::size_t i = 0; i < packet.at.size(); ++i) {
    put<8>(wire, kPlaceAt + 8 * i, std::bit_cast<std::uint64_t>(packet.at[i]));
  }
  put<4>(wire, kCrcAt, crc32(std::span(wire).first(kCrcAt)));
  return wire;
}

std::optional<Packet> decode(std::span<const std::uint8_t> bytes) EBAC_RT {
  if (bytes.size() != Packet::kSize || bytes[0] != 'E' || bytes[1] != 'T') return std::nullopt;
  if (bytes[2] != Packet::kVersion || bytes[3] >= kScheme * kSchemes) return std::nullopt;
  if (get<4>(bytes, kCrcAt) != crc32(bytes.first(kCrcAt))) return std::nullopt;
  Packet packet{.from_slave = (bytes[3] & kSlave) != 0,
                .lost = (bytes[3] & kLost) != 0,
                .session = static_cast<std::uint32_t>(get<4>(bytes, 4)),
                .sequence = static_cast<std::uint32_t>(get<4>(bytes, 8)),
                .echo = static_cast<std::uint32_t>(get<4>(bytes, 12)),
                .stamp = static_cast<std::int64_t>(get<8>(bytes, 16)),
                .value = number(bytes, 24),
                .energy = number(bytes, 32),
                .wave = number(bytes, 40),
                .run = static_cast<std::uint32_t>(get<4>(bytes, 48)),
                .fault = static_cast<std::uint32_t>(get<4>(bytes, 52)),
                .leaving = (bytes[3] & kLeaving) != 0,
                .scheme = static_cast<std::uint8_t>(bytes[3] / kScheme)};
  bool finite = std::isfinite(packet.value + packet.energy + packet.wave);
  for (std::size_t i = 0; i < packet.more.size(); ++i) {
    packet.more[i] = number(bytes, kMoreAt + 8 * i);
    finite = finite && std::isfinite(packet.more[i]);
  }
  for (std::size_t i = 0; i < packet.at.size(); ++i) {
    packet.at[i] = number(bytes, kPlaceAt + 8 * i);
    finite = finite && std::isfinite(packet.at[i]);
  }
  if (!finite) return std::nullopt;
  return packet;
}

}  // namespace ebac::teleop
