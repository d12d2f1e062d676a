#pragma once

#include <algorithm>

#include "ebac/canopen/cia402.hpp"

namespace ebac::can {

/// Takes drives to operation enabled, to rest or to a stop: a command for each drive state and
/// tick. Never waits; `tick` is called once per exchange.
class EnableSequence {
 public:
  enum class Goal : std::uint8_t { kRest, kRun, kStop };

  void want(Goal goal) EBAC_RT {
    goal_ = goal;
    ticks_ = 0;
    running_ = false;
  }
  void tick() EBAC_RT { ticks_ = std::min(ticks_ + 1, kMostTicks); }
  /// Every drive is enabled: from here on they get their torque.
  void run() EBAC_RT { running_ = true; }

  Goal goal() const EBAC_RT { return goal_; }
  bool running() const EBAC_RT { return running_; }
  bool enabling() const EBAC_RT { return goal_ == Goal::kRun && !running_; }
  int ticks() const EBAC_RT { return ticks_; }  // exchanges since it was wanted, kMostTicks at most

  DriveCommand command(DriveState state) const EBAC_RT {
    if (goal_ == Goal::kRun) return up_from(state);
    // Zero torque first, with the drive still on: its current is then zero when it lets go.
    const bool on = state == DriveState::kOperationEnabled;
    if (on && ticks_ < kZeroTicks) return DriveCommand::kEnableOperation;
    return goal_ == Goal::kRest ? down_from(state) : DriveCommand::kDisableVoltage;
  }

 private:
  static constexpr int kZeroTicks = 1;
  static constexpr int kMostTicks = 1'000'000'000;  // runs may last for weeks

  Goal goal_ = Goal::kRest;
  bool running_ = false;
  int ticks_ = 0;
};

}  // namespace ebac::can
