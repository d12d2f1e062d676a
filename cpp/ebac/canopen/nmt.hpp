#pragma once

#include <cstdint>
#include <limits>

#include "ebac/core/realtime.hpp"

namespace ebac::can {

/// NMT state of a node (CiA 301, 7.3.2), as in its heartbeat.
enum class NmtState : std::uint8_t {
  kBoot = 0x00,
  kStopped = 0x04,         // NMT and heartbeat alone
  kOperational = 0x05,     // everything
  kPreOperational = 0x7F,  // everything but PDOs
};

enum class NmtCommand : std::uint8_t {
  kStart = 0x01,
  kStop = 0x02,
  kPreOperational = 0x80,
  kResetNode = 0x81,
  kResetCommunication = 0x82,
};

inline constexpr std::int64_t kMicrosecond = 1000;      // ns
inline constexpr std::int64_t kMillisecond = 1000'000;  // ns
inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

/// Fires at most once per question, and then again a period after it was due.
class Timer {
 public:
  void start(std::int64_t now, std::int64_t period) EBAC_RT {
    period_ = period;
    due_ = period > 0 ? now + period : kNever;
  }
  bool due(std::int64_t now) EBAC_RT {
    if (now < due_) return false;
    due_ = due_ + period_ > now ? due_ + period_ : now + period_;
    return true;
  }

 private:
  std::int64_t period_ = 0;  // ns
  std::int64_t due_ = kNever;
};

/// Expires once when it is not fed for longer than its time. Inactive until first fed.
class Watchdog {
 public:
  void set(std::int64_t period) EBAC_RT {
    period_ = period;
    due_ = kNever;
  }
  void feed(std::int64_t now) EBAC_RT {
    if (period_ > 0) due_ = now + period_;
  }
  void sleep() EBAC_RT { due_ = kNever; }
  bool cries(std::int64_t now) EBAC_RT {
    if (now < due_) return false;
    due_ = kNever;
    return true;
  }

 private:
  std::int64_t period_ = 0;  // ns
  std::int64_t due_ = kNever;
};

}  // namespace ebac::can
