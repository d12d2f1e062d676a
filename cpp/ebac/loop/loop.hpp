#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "ebac/core/check.hpp"
#include "ebac/loop/loop_options.hpp"
#include "ebac/loop/parameter_updates.hpp"
#include "ebac/loop/plausibility.hpp"
#include "ebac/loop/row_parts.hpp"
#include "ebac/loop/row_writer.hpp"
#include "ebac/loop/tick.hpp"
#include "ebac/loop/trace.hpp"

namespace ebac {

/// Runs ticks and records their rows: Arm, Run, Stop, then Idle or Fault. A fault latches: its row
/// and the next ones, `stop_ticks` in all, command zero force, the device is stopped if it has
/// `stop`, and the loop ends for good: the next run takes a new loop.
template <Device D, Clock C, AxesController Law>
class Loop {
 public:
  Loop(D device, C clock, Law law, const SignalChain& chain, int axes,
       const LoopOptions& options = {})
      : device_(std::move(device)),
        clock_(std::move(clock)),
        law_(std::move(law)),
        chain_(chain),
        run_state_(options.plan),
        limiter_(options.limiter) {
    check(options.plan, "RunPlan");
    if (const auto facts = limiter_.watches_motion()) plausibility_.emplace(*facts);
    sample_.axes = axes;
  }

  /// A trace laid out for this loop, with room for `rows`; as a ring it keeps the last `rows`.
  std::shared_ptr<Trace> make_trace(std::size_t rows, bool ring = false) {
    return rows_.make_trace(static_cast<int>(sample_.axes), law_, parts(), rows, ring);
  }

  /// Runs to the end of the plan, to a fault or to a requested stop; returns false if a fault is
  /// latched. A full trace ends a simulation, and stops a run that armed its device: ticks without
  /// a row are counted.
  bool run(Trace& trace, ParameterUpdates<Law>* updates = nullptr) EBAC_RT {
    if (!start()) return false;
    while (advance(trace, updates)) {
    }
    return true;
  }

  /// Begins a run whose ticks `advance` takes; false if a fault is latched.
  bool start() EBAC_RT {
    if (!run_state_.start()) return false;
    if (run_state_.plan().arm) {
      if constexpr (requires { device_.enable(); }) {
        static_assert(noexcept(device_.enable()));
        device_.enable();
      }
    }
    return true;
  }

  /// Takes a tick; false when the run has ended.
  bool advance(Trace& trace, ParameterUpdates<Law>* updates = nullptr) EBAC_RT {
    std::byte* row = trace.next();
    if (row == nullptr && !run_state_.plan().arm) return run_state_.leave(), false;
    if (row == nullptr) run_state_.end();
    step(updates, row);
    if (row == nullptr) {
      unrecorded_.store(unrecorded_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    } else {
      trace.commit();
    }
    ++sample_.tick;
    return !run_state_.finish(at_rest());
  }

  LoopState state() const EBAC_RT { return run_state_.state(); }
  std::int64_t unrecorded() const EBAC_RT { return unrecorded_.load(std::memory_order_relaxed); }
  const Sample& sample() const EBAC_RT { return sample_; }
  D& device() EBAC_RT { return device_; }

 private:
  /// Whether the clock has columns in the trace.
  static constexpr bool kTimed = requires { typename C::State; };
  /// Whether the device is a log: in flight is what it says was sent, not what is commanded now.
  static constexpr bool kRecorded = requires(const D& log, double& one) {
    one = log.gain();
    one = log.sent(0);
  };

  /// A tick, and its row if there is room for one.
  void step(ParameterUpdates<Law>* updates, std::byte* row) EBAC_RT {
    if constexpr (Quick<D>) {
      if (sample_.axes == 1) return step_one(updates, row);
    }
    step(updates, row, axes_in_use(sample_));
  }

  EBAC_ONE_FUNCTION void step_one(ParameterUpdates<Law>* updates, std::byte* row) EBAC_RT {
    step(updates, row, only_axis(sample_));
  }

  template <std::size_t N>
  void step(ParameterUpdates<Law>* updates, std::byte* row, std::span<Axis, N> axes) EBAC_RT {
    const Instant now = clock_.wait();
    if (updates != nullptr) take(*updates);
    const bool arming = run_state_.state() == LoopState::kArm;
    if (arming) chain_.forget();  // counts that begin to arrive are no motion
    const Reading reading = sense(chain_, device_, now, sample_, axes);
    run_state_.advance(ready(), updates != nullptr && updates->stop_asked(), now.dt,
                       updates != nullptr && updates->at_once());
    if (limiter_.paused(now)) run_state_.resume();
    sample_.state = static_cast<int>(run_state_.state());
    if (run_state_.state() == LoopState::kArm) {
      rest(axes);
    } else {
      if (run_state_.first()) begin(axes);
      render(chain_, law_, now, axes);
      if (came() != 0) come_in();
    }
    if (arming) restart();
    note(reading, now, axes);
    double sent = 0;
    if (sample_.fault == Fault::kNone && run_state_.gain() > 0) {
      const int limited = limiter_.limit(axes, run_state_.gain(), now.dt);
      // What is stored now keeps the row waiting: see copy_words.
      if (limited != sample_.limited) sample_.limited = limited;
      sent = gain();
    } else {
      shut(now, axes);
    }
    if (sent != sample_.ramp) sample_.ramp = sent;
    chain_.sent_with(sent);
    stop_device();
    if constexpr (kTimed) clock_.finish();
    if (row != nullptr) rows_.write(row, sample_, axes.size(), law_, parts());
    if constexpr (kRecorded) {
      for (std::size_t i = 0; i < axes.size(); ++i) axes[i].joint.current = device_.sent(i);
    }
  }

  /// Not part of the tick's one function: a simulation has no updates.
  [[gnu::noinline]] void take(ParameterUpdates<Law>& updates) EBAC_RT {
    updates.apply(sample_.tick, law_, chain_, device_, axes_in_use(sample_), sample_.t);
  }

  /// Tells the law what its contacts store by a soft start, which no motion has paid for. Not part of the tick's one
  /// function: it is seldom called.
  [[gnu::noinline]] void come_in() EBAC_RT {
    if constexpr (requires { law_.come_in(0.0, true); }) {
      law_.come_in(came(), gain() >= 1);
    }
  }

  void restart() EBAC_RT {
    limiter_.restart();
    if (plausibility_) plausibility_->restart();
  }

  /// The law's memory starts here: motion while the device was being enabled is not counted as work.
  static void begin(std::span<Axis> axes) EBAC_RT {
    for (Axis& axis : axes) axis.port.dx = axis.port.dt = 0;
  }

  void note(const Reading& reading, const Instant& now, std::span<const Axis> axes) EBAC_RT {
    Fault watched = Fault::kNone;
    if (limiter_.on()) watched = limiter_.watch(reading, now, axes, starved_of(law_));
    if (plausibility_) {
      const Fault implausible = plausibility_->watch(reading, now, axes);
      if (watched == Fault::kNone) watched = implausible;
    }
    if (sample_.fault != Fault::kNone) return;
    const Fault judged = judge(reading, axes);
    const Fault found = judged != Fault::kNone ? judged : watched;
    if (found == Fault::kNone) return;
    sample_.fault = found;
    run_state_.fail(found);
    sample_.state = static_cast<int>(run_state_.state());
  }

  /// With which the force of this tick goes out; of a log, with which it went.
  double gain() const EBAC_RT {
    if constexpr (kRecorded) {
      return device_.gain();
    } else {
      return run_state_.gain();
    }
  }

  /// What has come in of it in this tick; of a log, what came in.
  double came() const EBAC_RT {
    if constexpr (kRecorded) {
      return device_.came();
    } else {
      return run_state_.came();
    }
  }

  /// Zero force: of a fault, of a stop, before the run.
  void shut(const Instant& now, std::span<Axis> axes) EBAC_RT {
    for (Axis& axis : axes) axis.port.f_cmd = axis.joint.tau = 0;
    limiter_.shut(axes, now.dt);
    sample_.limited = 0;
  }

  bool at_rest() const EBAC_RT {
    if constexpr (requires { device_.at_rest(); }) return device_.at_rest();
    return true;
  }

  bool ready() const EBAC_RT {
    if constexpr (requires { device_.running(); }) return device_.running();
    return true;
  }

  void stop_device() EBAC_RT {
    if (run_state_.state() != LoopState::kStop || !run_state_.stopping()) return;
    if (sample_.fault != Fault::kNone) {
      if constexpr (requires { device_.stop(); }) device_.stop();
    } else {
      if constexpr (requires { device_.disable(); }) {
        static_assert(noexcept(device_.disable()));
        device_.disable();
      }
    }
  }

  /// What has columns in a row besides the law.
  auto parts() const EBAC_RT {
    if constexpr (kTimed) {
      return std::tuple_cat(row_parts(device_), std::tie(limiter_, clock_));
    } else {
      return std::tuple_cat(row_parts(device_), std::tie(limiter_));
    }
  }

  D device_;
  C clock_;
  Law law_;
  SignalChain chain_;
  RunStateMachine run_state_;
  SafetyLimiter limiter_;
  std::optional<Plausibility> plausibility_;  // where the limits ask for it
  Sample sample_{};
  std::atomic<std::int64_t> unrecorded_{0};  // ticks
  RowWriter<Law, kRowParts<D> + (kTimed ? 2 : 1)> rows_;
};

}  // namespace ebac
