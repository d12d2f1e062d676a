#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "ebac/core/realtime.hpp"

/// Bilateral teleoperation: a master and a slave, joined by packets.
namespace ebac::teleop {

/// What one side sends the other, once a tick. On the wire 116 bytes, little-endian:
///
///     offset  type    content
///      0      u8[2]   'E' 'T'
///      2      u8      version, 4
///      3      u8      flags: 1 from the slave, 2 this side has lost the link, 4 this side ends, and 8 times its scheme
///      4      u32     session: the hand's consents so far
///      8      u32     sequence number, from 1 in each session
///     12      u32     echo: newest sequence number this side has received, 0 for none
///     16      i64     time stamp of the sender's own clock [ns]
///     24      f64     value: position of the master since it began [m], or force of the slave [N]
///     32      f64     energy that went into the network at this port since the session began [J]
///     40      f64     integral of the wave variable since the session began [sqrt(W) s]
///     48      u32     run: number of the master's run; from the slave, of the master it belongs to
///     52      u32     fault that has stopped the sender's drives, 0 for none
///     56      f64[3]  value of further axes: rotation, bend to the right, bend down [rad], or their load [N m]
///     80      f64[4]  from the slave: where its axes are, in the same order [m, rad]
///    112      u32     CRC-32 (IEEE 802.3) of the bytes before
///
/// A master and a slave of one axis leave the last three at 0.
struct Packet {
  static constexpr std::size_t kSize = 116;
  static constexpr std::uint8_t kVersion = 4;
  using Wire = std::array<std::uint8_t, kSize>;

  bool from_slave = false;
  bool lost = false;
  std::uint32_t session = 1;
  std::uint32_t sequence = 0;
  std::uint32_t echo = 0;
  std::int64_t stamp = 0;  // ns
  double value = 0;        // m or N
  double energy = 0;       // J
  double wave = 0;         // sqrt(W) s
  std::uint32_t run = 0;
  std::uint32_t fault = 0;
  bool leaving = false;
  std::uint8_t scheme = 0;       // of `Coupling`
  std::array<double, 3> more{};  // rad or N m
  std::array<double, 4> at{};    // m, rad

  bool operator==(const Packet&) const = default;
};

std::uint32_t crc32(std::span<const std::uint8_t> bytes) EBAC_RT;

Packet::Wire encode(const Packet& packet) EBAC_RT;

/// Nothing for a datagram of another length, magic number, version or flag, with a wrong CRC, or with
/// a number that is not finite.
std::optional<Packet> decode(std::span<const std::uint8_t> bytes) EBAC_RT;

}  // namespace ebac::teleop
