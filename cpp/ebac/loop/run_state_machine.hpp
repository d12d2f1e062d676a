#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "ebac/core/fields.hpp"
#include "ebac/core/sample.hpp"

namespace ebac {

/// Start and end of a run.
struct RunPlan {
  double soft_start = 0;  // s
  double ramp_down = 0;   // s
  int stop_ticks = 10;    // samples
  int rest_ticks = 0;     // samples
  bool arm = false;
  std::int64_t ticks = 0;  // samples

  static constexpr auto fields() {
    using F = Field<RunPlan>;
    return std::array{
        F{"soft_start", &RunPlan::soft_start, "s", "time in which the force comes in", 0, 60},
        F{"ramp_down", &RunPlan::ramp_down, "s", "time in which it goes out at a good end", 0, 10},
        F{"stop_ticks", &RunPlan::stop_ticks, "samples",
          "ticks with zero force in which the device is told to stop", 1, 100000},
        F{"rest_ticks", &RunPlan::rest_ticks, "samples",
          "further ticks of that kind for a device that is not at rest yet, at most", 0, 1e6},
        F{"arm", &RunPlan::arm, "1",
          "begin by enabling the device; a run that does always ends by a stop", 0, 1},
        F{"ticks", &RunPlan::ticks, "samples", "ticks under the law; 0 for until it is asked", 0,
          9e15},
    };
  }
};

/// State machine of a run (Idle, Arm, Run, Stop, Fault), with the gain of the force in each state.
class RunStateMachine {
 public:
  explicit RunStateMachine(const RunPlan& plan = {}) EBAC_RT : plan_(plan) {}

  /// False while it runs, and for good after a fault.
  bool start() EBAC_RT {
    if (state_ != LoopState::kIdle) return false;
    state_ = plan_.arm ? LoopState::kArm : LoopState::kRun;
    ran_ = stopped_ = 0;
    gain_ = plan_.soft_start > 0 || plan_.arm ? 0 : 1;
    return true;
  }

  /// Starts a tick, `dt` s after the last one; `asked`: a stop is requested; `at_once`: without its
  /// ramp.
  void advance(bool ready, bool asked, double dt, bool at_once = false) EBAC_RT {
    first_ = false;
    if (state_ == LoopState::kArm && asked) end();
    if (state_ == LoopState::kArm && ready) {
      state_ = LoopState::kRun;
      first_ = true;
    }
    if (state_ == LoopState::kRun && (asked || (plan_.ticks > 0 && ran_ >= plan_.ticks))) end();
    before_ = gain_;
    if (state_ == LoopState::kRun) {
      ++ran_;
      gain_ = plan_.soft_start > 0 ? std::min(1.0, gain_ + dt / plan_.soft_start) : 1.0;
    } else if (state_ == LoopState::kStop) {
      const bool ramp = fault_ == Fault::kNone && plan_.ramp_down > 0 && !at_once;
      gain_ = ramp ? std::max(0.0, gain_ - dt / plan_.ramp_down) : 0.0;
      if (gain_ == 0) ++stopped_;
    }
  }
  /// Latches a fault: the first one, and only while the loop runs.
  void fail(Fault fault) EBAC_RT {
    if (fault_ != Fault::kNone || fault == Fault::kNone) return;
    fault_ = fault;
    if (state_ != LoopState::kStop || gain_ > 0) stopped_ = 1;
    state_ = LoopState::kStop;
    gain_ = 0;
  }
  /// The loop has paused: zero force, which comes in as at the start.
  void resume() EBAC_RT {
    if (state_ == LoopState::kRun && plan_.soft_start > 0) gain_ = 0;
  }
  /// Ends a tick, after which the device is at rest or not; returns whether it was the last one.
  bool finish(bool at_rest = true) EBAC_RT {
    const int most = plan_.stop_ticks + (at_rest ? 0 : plan_.rest_ticks);
    if (state_ == LoopState::kStop && stopped_ >= most) {
      state_ = fault_ == Fault::kNone ? LoopState::kIdle : LoopState::kFault;
    }
    return state_ == LoopState::kIdle || state_ == LoopState::kFault;
  }
  /// Ends Arm or Run without a fault.
  void end() EBAC_RT {
    if (state_ == LoopState::kArm || state_ == LoopState::kRun) state_ = LoopState::kStop;
  }
  /// Ends at once: a simulation has no device to stop.
  void leave() EBAC_RT { state_ = fault_ == Fault::kNone ? LoopState::kIdle : LoopState::kFault; }

  LoopState state() const EBAC_RT { return state_; }
  Fault fault() const EBAC_RT { return fault_; }
  double gain() const EBAC_RT { return gain_; }  // of the force, 0 to 1
  /// What has been added to it in this tick, by a soft start; below zero after a pause.
  double came() const EBAC_RT { return state_ == LoopState::kRun ? gain_ - before_ : 0.0; }
  bool first() const EBAC_RT { return first_; }           // the first tick under the law, after Arm
  bool stopping() const EBAC_RT { return stopped_ > 0; }  // the force is zero: stop the device
  const RunPlan& plan() const EBAC_RT { return plan_; }

 private:
  RunPlan plan_;
  LoopState state_ = LoopState::kIdle;
  Fault fault_ = Fault::kNone;
  double gain_ = 0;
  double before_ = 0;
  bool first_ = false;
  std::int64_t ran_ = 0;  // ticks in kRun
  int stopped_ = 0;       // ticks of zero force in kStop
};

}  // namespace ebac
