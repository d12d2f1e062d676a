#include "ebac/loop/plausibility.hpp"

#include <algorithm>
#include <cmath>

namespace ebac {

Plausibility::Plausibility(const AllBalanceFacts& facts) : dt_(facts[0].dt) {
  for (std::size_t i = 0; i < facts.size(); ++i) {
    const auto over = [this, &of = facts[i]](double seconds) {
      const int ticks = static_cast<int>(std::lround(seconds / dt_));
      return ImpulseBalance(of, std::clamp(ticks, 4, ImpulseBalance::kMostTicks));
    };
    axis_[i] = {.slow = over(kSlow), .quick = over(kQuick)};
  }
}

Fault Plausibility::watch(const Reading& reading, const Instant& now,
                          std::span<const Axis> axes) EBAC_RT {
  const bool regular = now.skipped == 0 && std::abs(now.dt - dt_) <= kRegular * dt_ &&
                       reading.force_status == SensorStatus::kGood && reading.force_age <= kOldest;
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

void Plausibility::restart() EBAC_RT {
  for (AxisWatch& axis : axis_) axis.restart();
}

void Plausibility::Run::add(double excess) EBAC_RT {
  const bool turned = ticks > 0 && (excess > 0) != positive;
  if (excess == 0 || turned) before = excess == 0 ? 0 : ticks;
  ticks = excess == 0 ? 0 : turned ? 1 : ticks + 1;
  positive = excess > 0;
}

void Plausibility::AxisWatch::restart() EBAC_RT {
  slow.restart();
  quick.restart();
  slow_run = quick_run = {};
}

Fault Plausibility::AxisWatch::judge() EBAC_RT {
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

}  // namespace ebac
