#pragma once

#include <array>
#include <atomic>
#include <cstring>
#include <memory>
#include <tuple>
#include <utility>

#include "ebac/core/check.hpp"
#include "ebac/loop/course.hpp"
#include "ebac/loop/gate.hpp"
#include "ebac/loop/mail.hpp"
#include "ebac/loop/row_parts.hpp"
#include "ebac/loop/tick.hpp"
#include "ebac/loop/trace.hpp"

namespace ebac {

/// Everything of a loop but its parts: how it begins and ends, and what it allows.
struct LoopOptions {
  RunPlan plan{};
  Gate gate{};
};

/// Runs ticks and keeps their rows: Arm, Run, Stop, then Idle or Fault. A fault latches: its row and
/// the next ones, `stop_ticks` in all, command zero force, a device that can `stop` is told to, and
/// the loop ends; until `reset` it does not start again.
template <Device D, Clock C, AxesController Law>
class Loop {
 public:
  Loop(D device, C clock, Law law, const Rig& rig, int axes, const LoopOptions& options = {})
      : device_(std::move(device)),
        clock_(std::move(clock)),
        law_(std::move(law)),
        rig_(rig),
        course_(options.plan),
        gate_(options.gate) {
    check(options.plan, "RunPlan");
    sample_.axes = axes;
  }

  /// A trace laid out for this loop, with room for `rows`; as a ring it keeps the last `rows`.
  std::shared_ptr<Trace> make_trace(std::size_t rows, bool ring = false) {
    auto trace = std::make_shared<Trace>(static_cast<int>(sample_.axes));
    law_at_ = trace->template add_block<typename Law::State>("law.");
    std::apply(
        [&](const auto&... part) {
          [[maybe_unused]] std::size_t i = 0;
          ((device_at_[i++] = add_part(*trace, part)), ...);
        },
        row_parts(device_));
    if (gate_.on()) gate_at_ = add_part(*trace, gate_);
    if constexpr (kTimed) clock_at_ = add_part(*trace, clock_);
    trace->reserve(rows, ring);
    return trace;
  }

  /// Ticks to the end of the plan, to a fault or to `stop` in the mail; false when a fault stands.
  /// A full trace ends a simulation, and stops a run that armed its device: ticks without a row are
  /// counted.
  bool run(Trace& trace, Mail<Law>* mail = nullptr) EBAC_RT {
    if (!course_.start()) return false;
    if (course_.plan().arm) {
      if constexpr (requires {
                      { device_.enable() } noexcept;
                    })
        device_.enable();
    }
    for (bool over = false; !over;) {
      std::byte* row = trace.next();
      if (row == nullptr && !course_.plan().arm) return course_.leave(), true;
      if (row == nullptr) course_.end();
      step(mail, row);
      if (row == nullptr) {
        unrecorded_.store(unrecorded_.load(std::memory_order_relaxed) + 1,
                          std::memory_order_relaxed);
      } else {
        trace.commit();
      }
      ++sample_.tick;
      over = course_.finish();
    }
    return true;
  }

  /// Lets a loop that ended by a fault start again.
  bool reset() EBAC_RT {
    if (!course_.reset()) return false;
    sample_.fault = Fault::kNone;
    law_.reset();
    gate_.restart();
    return true;
  }

  LoopState state() const EBAC_RT { return course_.state(); }
  std::int64_t unrecorded() const EBAC_RT { return unrecorded_.load(std::memory_order_relaxed); }
  const Sample& sample() const EBAC_RT { return sample_; }
  D& device() EBAC_RT { return device_; }

 private:
  /// Whether the clock tells of its ticks.
  static constexpr bool kTimed = requires { typename C::State; };

  /// A tick, and its row if there is room for one.
  void step(Mail<Law>* mail, std::byte* row) EBAC_RT {
    if constexpr (Quick<D>) {
      if (sample_.axes == 1) return step_one(mail, row);
    }
    step(mail, row, axes_in_use(sample_));
  }

  EBAC_ONE_FUNCTION void step_one(Mail<Law>* mail, std::byte* row) EBAC_RT {
    step(mail, row, only_axis(sample_));
  }

  template <std::size_t N>
  void step(Mail<Law>* mail, std::byte* row, std::span<Axis, N> axes) EBAC_RT {
    const Instant now = clock_.wait();
    if (mail != nullptr) mail->deliver(sample_.tick, law_, rig_, device_);
    const bool arming = course_.state() == LoopState::kArm;
    if (arming) rig_.forget();  // counts that begin to arrive are no motion
    const Reading reading = sense(rig_, device_, now, sample_, axes);
    course_.advance(ready(), mail != nullptr && mail->stop_asked(), now.dt);
    sample_.state = static_cast<int>(course_.state());
    if (course_.state() == LoopState::kArm) {
      rest(axes);
    } else {
      if (course_.first()) begin(axes);
      render(rig_, law_, now, axes);
    }
    if (arming) gate_.restart();
    note(reading, now, axes);
    if (sample_.fault == Fault::kNone && course_.gain() > 0) {
      sample_.limited = gate_.pass(axes, course_.gain(), now.dt);
    } else {
      shut(now, axes);
    }
    tell_device();
    if constexpr (kTimed) clock_.finish();
    if (row != nullptr) append(row, axes.size());
  }

  /// The law's memory starts here: what moved while the device was being enabled is no work.
  static void begin(std::span<Axis> axes) EBAC_RT {
    for (Axis& axis : axes) axis.port.dx = axis.port.dt = 0;
  }

  void note(const Reading& reading, const Instant& now, std::span<const Axis> axes) EBAC_RT {
    const Fault watched = gate_.watch(reading, now, axes);
    if (sample_.fault != Fault::kNone) return;
    const Fault judged = judge(reading, axes);
    sample_.fault = judged != Fault::kNone ? judged : watched;
    course_.fail(sample_.fault);
    sample_.state = static_cast<int>(course_.state());
  }

  /// Zero force: of a fault, of a stop, before the run.
  void shut(const Instant& now, std::span<Axis> axes) EBAC_RT {
    for (Axis& axis : axes) axis.port.f_cmd = axis.joint.tau = 0;
    gate_.shut(axes, now.dt);
    sample_.limited = 0;
  }

  bool ready() const EBAC_RT {
    if constexpr (requires { device_.running(); }) return device_.running();
    return true;
  }

  void tell_device() EBAC_RT {
    if (course_.state() != LoopState::kStop || !course_.stopping()) return;
    if (sample_.fault != Fault::kNone) {
      if constexpr (requires { device_.stop(); }) device_.stop();
    } else {
      if constexpr (requires {
                      { device_.disable() } noexcept;
                    })
        device_.disable();
    }
  }

  template <class Part>
  static std::size_t add_part(Trace& trace, const Part&) {
    return trace.template add_block<typename Part::State>(std::string(Part::kPrefix));
  }

  void append(std::byte* row, std::size_t axes) const EBAC_RT {
    std::memcpy(row, &sample_, offsetof(Sample, axis) + axes * sizeof(Axis));
    copy_states(row + law_at_, law_, axes);
    std::apply(
        [&](const auto&... part) EBAC_RT {
          [[maybe_unused]] std::size_t i = 0;
          (copy_states(row + device_at_[i++], part, axes), ...);
        },
        row_parts(device_));
    if (gate_.on()) copy_states(row + gate_at_, gate_, axes);
    if constexpr (kTimed) copy_states(row + clock_at_, clock_, axes);
  }

  template <class Part>
  static void copy_states(std::byte* row, const Part& part, std::size_t axes) EBAC_RT {
    using State = Part::State;
    if constexpr (State::fields().size() > 0) {
      for (std::size_t i = 0; i < axes; ++i) {
        std::memcpy(row + i * sizeof(State), &part.state(i), sizeof(State));
      }
    }
  }

  D device_;
  C clock_;
  Law law_;
  Rig rig_;
  Course course_;
  Gate gate_;
  Sample sample_{};
  std::size_t gate_at_ = 0;
  std::size_t clock_at_ = 0;
  std::atomic<std::int64_t> unrecorded_{0};  // ticks
  std::size_t law_at_ = 0;
  std::array<std::size_t, kRowParts<D>> device_at_{};
};

}  // namespace ebac
