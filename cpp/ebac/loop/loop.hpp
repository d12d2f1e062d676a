#pragma once

#include <array>
#include <cstring>
#include <memory>
#include <tuple>
#include <utility>

#include "ebac/loop/row_parts.hpp"
#include "ebac/loop/tick.hpp"
#include "ebac/loop/trace.hpp"

namespace ebac {

/// Runs ticks and keeps their rows. A fault latches: its row and the next ones, `kStopTicks` in
/// all, command zero force, a device that can `stop` is told to, and the loop ends.
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
    std::apply(
        [&](const auto&... part) {
          [[maybe_unused]] std::size_t i = 0;
          ((device_at_[i++] = add_part(*trace, part)), ...);
        },
        row_parts(device_));
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
      if (sample_.fault != Fault::kNone) {
        if constexpr (requires { device_.stop(); }) device_.stop();
        ++stopping;
      }
    }
  }

  const Sample& sample() const EBAC_RT { return sample_; }
  D& device() EBAC_RT { return device_; }

 private:
  template <class Part>
  static std::size_t add_part(Trace& trace, const Part&) {
    return trace.template add_block<typename Part::State>(std::string(Part::kPrefix));
  }

  void append(std::byte* row) const EBAC_RT {
    const auto axes = static_cast<std::size_t>(sample_.axes);
    std::memcpy(row, &sample_, offsetof(Sample, axis) + axes * sizeof(Axis));
    copy_states(row + law_at_, law_, axes);
    std::apply(
        [&](const auto&... part) EBAC_RT {
          [[maybe_unused]] std::size_t i = 0;
          (copy_states(row + device_at_[i++], part, axes), ...);
        },
        row_parts(device_));
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
  std::array<std::size_t, kRowParts<D>> device_at_{};
};

}  // namespace ebac
