#pragma once

#include <array>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac {

inline constexpr int kMaxDelay = 8;  // samples

/// Timing for which a law is designed: the nominal tick, and the delay of a command.
struct Timing {
  double dt = 1e-3;   // s
  int delay = 1;      // samples
  double jitter = 0;  // of a sample

  bool operator==(const Timing&) const = default;

  /// The longest interval a command may act for: both of its ticks off by `jitter`.
  double longest() const EBAC_RT { return dt * (1 + 2 * jitter); }

  /// A command computed in tick k acts over the interval that starts at tick k + delay.
  static constexpr auto fields() {
    using F = Field<Timing>;
    return std::array{
        F{"dt", &Timing::dt, "s", "sample time", 1e-5, 0.1},
        F{"delay", &Timing::delay, "samples",
          "ticks from computing a command to its acting; 1 is a synchronous CAN drive", 0,
          kMaxDelay},
        F{"jitter", &Timing::jitter, "1",
          "largest deviation of a tick from its instant, over the sample time, that laws count "
          "with",
          0, 0.45},
    };
  }
};

}  // namespace ebac
