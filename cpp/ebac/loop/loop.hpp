#pragma once

#include <cstring>
#include <memory>
#include <utility>

#include "ebac/loop/tick.hpp"
#include "ebac/loop/trace.hpp"

namespace ebac {

/// Runs ticks and keeps their rows. A fault latches: its row and the next ones, `kStopTicks` in
/// all, command zero force, and the loop ends.
template <Device D, Clock C, AxesController Law>
class Loop {
 public:
  static constexpr int kStopTicks = 10;

  Loop(D device, C clock, Law law, const Rig& rig, int axes)
      : device_(std::move(device)), clock_(std::move(clock)), law_(std::move(law)), rig_(rig) {
    sample_.axes = axes;
  }

  /// A trace laid out for this loop, with room for `rows`.
  std::shared_ptr<Trace> make_trace(std::size_t rows) {
    auto trace = std::make_shared<Trace>(static_cast<int>(sample_.axes));
    law_at_ = trace->template add_block<typename Law::State>("law.");
    if constexpr (requires { typename D::State; }) {
      device_at_ = trace->template add_block<typename D::State>("true.");
    }
    trace->reserve(rows);
    return trace;
  }

  /// Ticks until the trace is full or a fault has been answered.
  void run(Trace& trace) EBAC_RT {
    int stopping = 0;
    for (std::byte* row = trace.next(); row != nullptr && stopping < kStopTicks;
         row = trace.next()) {
      tick(rig_, law_, device_, clock_.wait(), sample_);
      append(row);
      trace.commit();
      ++sample_.tick;
      if (sample_.fault != Fault::kNone) ++stopping;
    }
  }

  const Sample& sample() const EBAC_RT { return sample_; }

 private:
  void append(std::byte* row) const EBAC_RT {
    const auto axes = static_cast<std::size_t>(sample_.axes);
    std::memcpy(row, &sample_, offsetof(Sample, axis) + axes * sizeof(Axis));
    copy_states(row + law_at_, law_, axes);
    if constexpr (requires { typename D::State; }) copy_states(row + device_at_, device_, axes);
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
  Sample sample_{};
  std::size_t law_at_ = 0;
  std::size_t device_at_ = 0;
};

}  // namespace ebac
