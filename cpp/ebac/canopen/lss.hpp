#pragma once

#include <array>
#include <cstdint>

#include "ebac/can/frame.hpp"
#include "ebac/canopen/cob_id.hpp"

namespace ebac::can {

inline constexpr std::uint32_t kLssMaster = 0x7E5;
inline constexpr std::uint32_t kLssSlave = 0x7E4;

/// Layer setting services of a node (CiA 305): who it is, and its node id and bit rate to come.
class LssSlave {
 public:
  /// Vendor, product, revision, serial number (0x1018).
  using Identity = std::array<std::uint32_t, 4>;

  /// Takes a frame of the master; true where `reply` is to be sent. `node` is the present id.
  bool answer(const Frame& frame, const Identity& own, NodeId node, Frame& reply) EBAC_RT {
    if (frame.size != Frame::kMaxSize) return false;
    reply = {.id = kLssSlave, .size = Frame::kMaxSize};
    const std::uint8_t command = frame.data[0];
    const auto value = get<std::uint32_t>(frame.bytes(), 1);
    if (command == 0x04) {  // switch state global
      configuring_ = frame.data[1] == 1;
      return false;
    }
    if (command >= 0x40 && command <= 0x43) return select(command - 0x40U, value, own, reply);
    if (command >= 0x46 && command <= 0x4B) return identify(command, value, own, reply);
    if (command == 0x51) return scan(frame, own, reply);
    if (!configuring_) return false;
    reply.data[0] = command;
    return configure(frame, own, node, reply);
  }

  /// The node id that a reset of the communication brings, or 0 for the present one.
  NodeId pending() const EBAC_RT { return pending_; }
  /// A reset of the communication: the node waits as before.
  void reset() EBAC_RT { *this = {}; }

 private:
  static bool said(Frame& reply, std::uint8_t command) EBAC_RT {
    reply.data[0] = command;
    return true;
  }

  /// Switch state selective: four numbers, one after the other.
  bool select(std::size_t part, std::uint32_t value, const Identity& own, Frame& reply) EBAC_RT {
    matched_ = value == own[part] && matched_ == part ? part + 1 : 0;
    if (matched_ < own.size()) return false;
    matched_ = 0;
    configuring_ = true;
    return said(reply, 0x44);
  }

  /// Identify remote slave: vendor, product, and ranges of revision and serial number.
  bool identify(std::uint8_t command, std::uint32_t value, const Identity& own,
                Frame& reply) EBAC_RT {
    const std::size_t step = command - 0x46U;
    constexpr std::array<std::size_t, 6> kPart{0, 1, 2, 2, 3, 3};
    const std::uint32_t mine = own[kPart[step]];
    const bool fits = step < 2 ? value == mine : (step & 1U) == 0 ? value <= mine : value >= mine;
    identified_ = fits && identified_ == step ? step + 1 : 0;
    if (identified_ < kPart.size()) return false;
    identified_ = 0;
    return said(reply, 0x4F);
  }

  /// Fastscan: bit by bit, part by part; the one who matches all of it is selected.
  bool scan(const Frame& frame, const Identity& own, Frame& reply) EBAC_RT {
    const auto wanted = get<std::uint32_t>(frame.bytes(), 1);
    const std::uint8_t bit = frame.data[5];
    const std::uint8_t part = frame.data[6];
    const std::uint8_t next = frame.data[7];
    if (configuring_) return false;
    if (bit == 0x80) {
      scanned_ = 0;
      return said(reply, 0x4F);
    }
    if (bit > 31 || part > 3 || next > 3 || part != scanned_) return false;
    if ((own[part] ^ wanted) >> bit != 0) return false;
    if (bit == 0) {
      scanned_ = next;
      configuring_ = part == 3;
    }
    return said(reply, 0x4F);
  }

  bool configure(const Frame& frame, const Identity& own, NodeId node, Frame& reply) EBAC_RT {
    const std::uint8_t command = frame.data[0];
    switch (command) {
      case 0x11: {  // node id, effective after a reset
        const std::uint8_t wanted = frame.data[1];
        const bool fits = wanted >= 1 && wanted <= kLastNode;
        if (fits) pending_ = wanted;
        reply.data[1] = fits ? 0 : 1;
        return true;
      }
      case 0x13:  // bit timing: 1 Mbit/s to 10 kbit/s by CiA's table, of which 5 is reserved
        reply.data[1] = frame.data[1] == 0 && frame.data[2] <= 8 && frame.data[2] != 5 ? 0 : 1;
        return true;
      case 0x17:  // store
        return true;
      case 0x5A:
      case 0x5B:
      case 0x5C:
      case 0x5D:
        put<std::uint32_t>(reply.data, 1, own[command - 0x5AU]);
        return true;
      case 0x5E:
        reply.data[1] = node;
        return true;
      default:
        return false;
    }
  }

  bool configuring_ = false;
  NodeId pending_ = 0;
  std::size_t matched_ = 0;
  std::size_t identified_ = 0;
  std::size_t scanned_ = 0;
};

}  // namespace ebac::can
