#pragma once

#include <array>
#include <cstdint>

#include "ebac/core/realtime.hpp"

/// Causes of drive errors, with the error code of each.
namespace ebac::can {

enum class Cause : std::uint8_t {
  kOverVoltage,
  kEncoderLost,
  kOverTemperature,
  kUnderVoltage,
  kMotorTemperature,
  kShortCircuit,
  kMotorBlocked,   // the brake does not open
  kSyncLength,     // a SYNC with a counter, or without one, against 0x1019
  kOverload,       // i2t
  kHeartbeatLost,  // a producer of 0x1016 fell silent
  kRpdoLate,       // an RPDO stayed away longer than its event timer
  kRpdoShort,      // an RPDO with too few bytes
  kSyncLost,       // no SYNC for kSyncPatience periods of 0x1006
  kConnection,     // the node left Operational while the motor was on
};
inline constexpr std::size_t kCauses = 14;

/// Periods of 0x1006 without a SYNC until it is lost. A loop on an ordinary kernel is several late
/// now and then: 6 of 1 ms in one of a thousand ticks.
inline constexpr std::int64_t kSyncPatience = 20;

struct CauseFacts {
  std::uint16_t emcy;     // error code (CiA 301, table 26; CiA 402-2)
  std::uint8_t reg;       // bit of 0x1001
  std::uint32_t latched;  // bit of 0x2183
  std::uint32_t event;    // bit of 0x1002
};

/// Bits of 0x2183 and 0x1002 as Copley counts them. 0x400 is confirmed, the others are indicative.
inline constexpr std::array<CauseFacts, kCauses> kCauseFacts{{
    {0x3210, 0x04, 1U << 5, 1U << 2},
    {0x7305, 0x20, 1U << 7, 1U << 5},
    {0x4210, 0x08, 1U << 3, 1U << 1},
    {0x3220, 0x04, 1U << 6, 1U << 3},
    {0x4310, 0x08, 1U << 4, 1U << 4},
    {0x2320, 0x02, 1U << 2, 1U << 0},
    {0x7121, 0x20, 1U << 12, 1U << 14},
    {0x8240, 0x10, 0, 0},
    {0x2350, 0x02, 1U << 10, 1U << 7},
    {0x8130, 0x10, 0, 0},
    {0x8250, 0x10, 0, 0},
    {0x8210, 0x10, 0, 0},
    {0x8700, 0x10, 0, 0},
    {0x8100, 0x10, 0, 0},
}};
constexpr const CauseFacts& facts_of(Cause cause) EBAC_RT {
  return kCauseFacts[static_cast<std::size_t>(cause)];
}

/// Present causes, and causes reported but not yet reset.
class ErrorState {
 public:
  /// True when it is news.
  bool raise(Cause cause) EBAC_RT {
    const bool news = (active_ & bit(cause)) == 0;
    present_ |= bit(cause);
    active_ |= bit(cause);
    return news;
  }
  /// Ends a cause; it stays reported until a reset.
  void gone(Cause cause) EBAC_RT { present_ &= ~bit(cause); }
  /// Ends a cause and its report; true if it was reported.
  bool forget(Cause cause) EBAC_RT {
    const bool was = (active_ & bit(cause)) != 0;
    present_ &= ~bit(cause);
    active_ &= ~bit(cause);
    return was;
  }
  bool present(Cause cause) const EBAC_RT { return (present_ & bit(cause)) != 0; }
  bool any_present() const EBAC_RT { return present_ != 0; }
  /// Forgets all that is over; true when anything was.
  bool reset() EBAC_RT {
    const std::uint32_t before = active_;
    active_ &= present_;
    return active_ != before;
  }
  void clear() EBAC_RT { present_ = active_ = 0; }

  /// 0x1001: bit 0 with any other.
  std::uint8_t reg() const EBAC_RT {
    const auto bits = static_cast<std::uint8_t>(sum(active_, &CauseFacts::reg));
    return bits == 0 ? bits : static_cast<std::uint8_t>(bits | 1U);
  }
  std::uint32_t events() const EBAC_RT { return sum(present_, &CauseFacts::event); }
  std::uint32_t latched() const EBAC_RT { return sum(present_, &CauseFacts::latched); }

 private:
  static constexpr std::uint32_t bit(Cause cause) EBAC_RT {
    return 1U << static_cast<unsigned>(cause);
  }
  template <class Bits>
  static std::uint32_t sum(std::uint32_t causes, Bits CauseFacts::* bits) EBAC_RT {
    std::uint32_t all = 0;
    for (std::size_t i = 0; i < kCauses; ++i) {
      if ((causes >> i & 1U) != 0) all |= facts_of(static_cast<Cause>(i)).*bits;
    }
    return all;
  }

  std::uint32_t present_ = 0;
  std::uint32_t active_ = 0;
};

}  // namespace ebac::can
