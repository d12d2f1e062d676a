#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "ebac/core/concepts.hpp"
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
  explicit Plausibility(const AllBalanceFacts& facts) : dt_(facts[0].dt) {
    for (std::size_t i = 0; i < facts.size(); ++i) {
      const auto over = [this, &of = facts[i]](double seconds) {
        const int ticks = static_cast<int>(std::lround(seconds / dt_));
        return ImpulseBalance(of, std::clamp(ticks, 4, ImpulseBalance::kMostTicks));
      };
      axis_[i] = {.slow = over(kSlow), .quick = over(kQuick)};
    }
  }
  /// Of axes that are all alike.
  explicit Plausibility(const BalanceFacts& facts)
      : Plausibility(AllBalanceFacts{facts, facts, facts}) {}

  /// The contradiction found in this tick, if any. A tick that came too early or too late, a position
  /// that is not this tick's, and a force that is old or not good begin the balances anew.
  Fault watch(const Reading& reading, const Instant& now, std::span<const Axis> axes) EBAC_RT {
    const bool regular = now.skipped == 0 && std::abs(now.dt - dt_) <= kRegular * dt_ &&
                         reading.force_status == SensorStatus::kGood &&
                         reading.force_age <= kOldest;
    Fault found = Fault::kNone;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      AxisWatch& axis = axis_[i];
      if (regular && reading.counts_age[i] == 0) {
        const Port& port = axes[i].port;
        axis.slow.step(port.x, port.f_meas, reading.force_age, port.f_applied);
        axis.quick.step(port.x, port.f_meas, reading.force_age, port.f_applied);
        const Fault fault = axis.judge();
        if (found == Fault::kNone) found = fault;
      } else {
        axis.restart();
      }
    }
    return found;
  }

  void restart() EBAC_RT {
    for (AxisWatch& axis : axis_) axis.restart();
  }

 private:
  static constexpr double kSlow = 15e-3;   // s, half a balance
  static constexpr double kQuick = 5e-3;   // s
  static constexpr double kRegular = 0.3;  // of a tick
  static constexpr double kOldest = 5e-3;  // s, of a force

  /// Ticks in a row with an excess of one sign, and how many the other sign had right before.
  struct Run {
    int ticks = 0, before = 0;
    bool positive = false;

    void add(double excess) EBAC_RT {
      const bool turned = ticks > 0 && (excess > 0) != positive;
      if (excess == 0 || turned) before = excess == 0 ? 0 : ticks;
      ticks = excess == 0 ? 0 : turned ? 1 : ticks + 1;
      positive = excess > 0;
    }
  };

  struct AxisWatch {
    ImpulseBalance slow{}, quick{};
    Run slow_run{}, quick_run{};

    void restart() EBAC_RT {
      slow.restart();
      quick.restart();
      slow_run = quick_run = {};
    }

    Fault judge() EBAC_RT {
      slow_run.add(slow.excess());
      quick_run.add(quick.excess());
      const int soon = quick.ticks() - 1;
      if (quick_run.ticks >= soon) {
        // A position that steps bends its path one way and then, n ticks later, the other.
        if (quick_run.before >= soon) return Fault::kEncoderJump;
        const bool stopped = quick.still() >= quick.ticks() && quick.still() < 2 * quick.ticks();
        if (stopped) return Fault::kEncoderFrozen;
      }
      if (slow_run.ticks < slow.ticks()) return Fault::kNone;
      if (slow.agrees_reversed()) return Fault::kTorqueReversed;
      if (slow.still() >= slow.ticks()) return Fault::kEncoderFrozen;
      return slow_run.ticks < 2 * slow.ticks() ? Fault::kNone : Fault::kMotionImplausible;
    }
  };

  double dt_ = 1e-3;  // s
  std::array<AxisWatch, kMaxAxes> axis_{};
};

}  // namespace ebac
