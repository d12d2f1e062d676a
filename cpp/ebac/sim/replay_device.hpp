#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "ebac/core/clock.hpp"
#include "ebac/core/device.hpp"
#include "ebac/loop/observer_params.hpp"

/// A recorded log as hardware: its counts, applied currents and forces drive a law open loop.
/// Nothing the new law commands comes back: the hand and the device move as they did.
namespace ebac {

/// Recorded values of one axis in one tick.
struct ReplayAxis {
  /// Requests and commands of the recorded law, beside those of the new one.
  struct State {
    double f_env = 0;    // N
    double f_cmd = 0;    // N
    double current = 0;  // A

    static constexpr auto fields() {
      using F = Field<State>;
      return std::array{
          F{"f_env", &State::f_env, "N", "force the virtual world asked for when it was recorded"},
          F{"f_cmd", &State::f_cmd, "N", "force the recorded law commanded"},
          F{"current", &State::current, "A", "motor current asked when it was recorded"},
      };
    }
  };

  std::int64_t counts = 0;     // raw or unwrapped
  double counts_age = 0;       // s, since they were latched
  double current_applied = 0;  // A, over the interval that ended now
  double force = 0;            // N, force sensor
  State recorded;
};

/// What was recorded of the whole device in one tick.
struct ReplayRow {
  Instant instant;
  Fault fault = Fault::kNone;  // of the device; kNone where a law or the world was at fault
  double force_age = 0;        // s
  SensorStatus force_status = SensorStatus::kGood;
  double gain = 1;  // of soft start or stop, with which the currents of this tick were sent
  double came = 0;  // what had been added to it in this tick
};

/// The ticks of a log. Row i has `axes` entries in `axis`, from i * axes on.
struct ReplayLog {
  std::size_t axes = 1;
  std::vector<ReplayRow> row;
  std::vector<ReplayAxis> axis;
  std::optional<ObserverParams> observer{};

  std::size_t rows() const EBAC_RT { return row.size(); }
};

/// A log as a device. Answers tick after tick, whatever the commands.
class ReplayDevice {
 public:
  using State = ReplayAxis::State;
  static constexpr std::string_view kPrefix = "log.";

  /// A log of one row at least.
  explicit ReplayDevice(std::shared_ptr<const ReplayLog> log) : log_(std::move(log)) {}

  Reading exchange(const Command&) EBAC_RT {
    at_ = std::min(next_, log_->rows() - 1);
    ++next_;
    const ReplayRow& row = log_->row[at_];
    Reading reading{
        .force_age = row.force_age, .force_status = row.force_status, .fault = row.fault};
    for (std::size_t i = 0; i < log_->axes; ++i) {
      const ReplayAxis& axis = log_->axis[at_ * log_->axes + i];
      reading.counts[i] = axis.counts;
      reading.counts_age[i] = axis.counts_age;
      reading.current_applied[i] = axis.current_applied;
      reading.force[i] = axis.force;
    }
    return reading;
  }

  /// Of the tick: the current that was sent [A], and the gain of soft start or stop in it.
  double sent(std::size_t axis) const EBAC_RT { return state(axis).current; }
  double gain() const EBAC_RT { return log_->row[at_].gain; }
  double came() const EBAC_RT { return log_->row[at_].came; }

  const State& state(std::size_t axis) const EBAC_RT {
    return log_->axis[at_ * log_->axes + axis].recorded;
  }

 private:
  std::shared_ptr<const ReplayLog> log_;
  std::size_t next_ = 0;
  std::size_t at_ = 0;
};

static_assert(Device<ReplayDevice>);

/// The instants at which the log was recorded.
class ReplayClock {
 public:
  explicit ReplayClock(std::shared_ptr<const ReplayLog> log) : log_(std::move(log)) {}

  Instant wait() EBAC_RT { return log_->row[std::min(next_++, log_->rows() - 1)].instant; }

 private:
  std::shared_ptr<const ReplayLog> log_;
  std::size_t next_ = 0;
};

static_assert(Clock<ReplayClock>);

}  // namespace ebac
