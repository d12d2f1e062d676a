#pragma once

#include <array>
#include <span>

#include "ebac/core/clock.hpp"
#include "ebac/core/device.hpp"
#include "ebac/loop/impulse_balance.hpp"

namespace ebac {

/// Holds encoder, force sensor and motor of each axis against the model of the device, by two impulse
/// balances: one over 30 ms, and one over 10 ms for a handle that stops dead. A contradiction must
/// last as long as half a balance, so that a single position that is wrong, or old, is none.
///
/// What it names needs more force than the bound: a friction that holds the handle, and a hand that
/// is not felt by the sensor, look the same as an encoder that does not move.
class Plausibility {
 public:
  Plausibility() = default;
  explicit Plausibility(const AllBalanceFacts& facts);
  /// Of axes that are all alike.
  explicit Plausibility(const BalanceFacts& facts)
      : Plausibility(AllBalanceFacts{facts, facts, facts}) {}

  /// The contradiction found in this tick, if any. A tick that came too early or too late, a position
  /// that is not this tick's, and a force that is old or not good begin the balances anew.
  Fault watch(const Reading& reading, const Instant& now, std::span<const Axis> axes) EBAC_RT;

  void restart() EBAC_RT;

 private:
  static constexpr double kSlow = 15e-3;   // s, half a balance
  static constexpr double kQuick = 5e-3;   // s
  static constexpr double kRegular = 0.3;  // of a tick
  static constexpr double kOldest = 5e-3;  // s, of a force

  /// Ticks in a row with an excess of one sign, and how many the other sign had right before.
  struct Run {
    int ticks = 0, before = 0;
    bool positive = false;

    void add(double excess) EBAC_RT;
  };

  struct AxisWatch {
    ImpulseBalance slow{}, quick{};
    Run slow_run{}, quick_run{};

    void restart() EBAC_RT;
    Fault judge() EBAC_RT;
  };

  double dt_ = 1e-3;  // s
  std::array<AxisWatch, kMaxAxes> axis_{};
};

}  // namespace ebac
