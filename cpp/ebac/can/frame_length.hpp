#pragma once

#include "ebac/can/frame.hpp"

/// How many bits a frame takes on the wire (ISO 11898-1).
namespace ebac::can {

/// A frame bit by bit, as far as bits are stuffed: its CRC-15, and one bit of the other value after
/// every five alike, which counts for the next five.
class StuffedBits {
 public:
  constexpr void push(bool bit) EBAC_RT {
    const bool top = ((crc_ >> 14U & 1U) != 0) != bit;
    crc_ = (crc_ << 1U & 0x7FFFU) ^ (top ? kPolynomial : 0U);
    ++count_;
    run_ = bit == last_ ? run_ + 1 : 1;
    last_ = bit;
    if (run_ < kAlike) return;
    ++count_;
    run_ = 1;
    last_ = !bit;
  }
  /// The lowest `bits` bits of `word`, the highest of them first.
  constexpr void push(std::uint32_t word, int bits) EBAC_RT {
    while (bits-- > 0) push((word >> static_cast<unsigned>(bits) & 1U) != 0);
  }
  constexpr std::uint32_t crc() const EBAC_RT { return crc_; }
  constexpr int count() const EBAC_RT { return count_; }  // bits, with the stuffed ones

 private:
  static constexpr std::uint32_t kPolynomial = 0x4599;
  static constexpr int kAlike = 5;

  std::uint32_t crc_ = 0;
  int count_ = 0;
  int run_ = 0;
  bool last_ = true;  // the bus is idle: recessive
};

/// Bits of a frame with those that are stuffed, delimiters, acknowledgement, end and the space after it.
constexpr int exact_bits(const Frame& frame) EBAC_RT {
  constexpr int kCrc = 15;
  constexpr int kNeverStuffed = 1 + 2 + 7 + 3;  // CRC delimiter, ACK, end, interframe space
  StuffedBits bits;
  bits.push(false);  // start of frame
  if (frame.extended) {
    bits.push(frame.id >> 18U, 11);
    bits.push(0b11, 2);  // SRR, IDE
    bits.push(frame.id, 18);
    bits.push(frame.remote);
    bits.push(0, 2);  // r1, r0
  } else {
    bits.push(frame.id, 11);
    bits.push(frame.remote);
    bits.push(0, 2);  // IDE, r0
  }
  bits.push(frame.size, 4);
  if (!frame.remote) {
    for (const std::uint8_t byte : frame.bytes()) bits.push(byte, 8);
  }
  bits.push(bits.crc(), kCrc);
  return bits.count() + kNeverStuffed;
}

/// What arbitration compares, bit by bit: the frame with the lowest goes first.
constexpr std::uint32_t priority(const Frame& frame) EBAC_RT {
  const std::uint32_t remote = frame.remote ? 1 : 0;
  if (!frame.extended) return frame.id << 21U | remote << 20U;
  return frame.id >> 18U << 21U | 0b11U << 19U | (frame.id & 0x3FFFFU) << 1U | remote;
}

}  // namespace ebac::can
