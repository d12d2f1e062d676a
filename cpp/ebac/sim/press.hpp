#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "ebac/sim/sweep.hpp"

/// Effort of a press on a wall: a criterion for the choice of gains, beside the contact itself.
namespace ebac {

/// Effort of one run; NaN where a run is too short for it.
struct PressEffort {
  double most_force = 0;              // N
  double most_current = 0;            // A
  double noise = WallContact::kNone;  // N
  double lateness = 0;                // m s

  static constexpr auto fields() {
    using F = Field<PressEffort>;
    return std::array{
        F{"most_force", &PressEffort::most_force, "N", "largest applied force of any port"},
        F{"most_current", &PressEffort::most_current, "A", "largest current asked of any motor"},
        F{"noise", &PressEffort::noise, "N",
          "of the command over the last 30 %: changes from tick to tick, root mean square over the "
          "square root of two"},
        F{"lateness", &PressEffort::lateness, "m s",
          "integral of t |x - goal| over the run, by its length"},
    };
  }
};

/// Follows the rows of a run.
class EffortWatch {
 public:
  EffortWatch(std::size_t rows, double goal)
      : tail_(rows - static_cast<std::size_t>(std::lround(kTailShare * static_cast<double>(rows)))),
        goal_(goal) {}

  void operator()(const Sample& s, const SimulatedDevice& device) EBAC_RT {
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.axes); ++i) {
      const Axis& axis = s.axis[i];
      effort_.most_force = std::max(effort_.most_force, std::abs(axis.port.f_applied));
      effort_.most_current = std::max(effort_.most_current, std::abs(axis.joint.current));
    }
    const Port& port = s.axis[0].port;
    late_ += s.t * std::abs(device.state(0).x - goal_) * port.dt;
    if (row_ > tail_) squares_ += (port.f_cmd - before_) * (port.f_cmd - before_);
    before_ = port.f_cmd;
    seconds_ = s.t;
    ++row_;
  }

  PressEffort effort() const {
    PressEffort out = effort_;
    if (row_ > tail_ + 1) {
      out.noise = std::sqrt(0.5 * squares_ / static_cast<double>(row_ - tail_ - 1));
    }
    out.lateness = seconds_ > 0 ? late_ / seconds_ : 0.0;
    return out;
  }

 private:
  std::size_t tail_;  // first row of it
  double goal_;       // m
  std::size_t row_ = 0;
  double before_ = 0;   // N
  double squares_ = 0;  // N^2
  double late_ = 0;     // m s^2
  double seconds_ = 0;  // s
  PressEffort effort_{};
};

struct Press {
  Outcome outcome{};
  PressEffort effort{};
};

/// Runs setups[i] under *laws[i], of which the first axis ought to come to goals[i] [m].
template <ScalarLaw Law>
std::vector<Press> press(const std::vector<const Setup*>& setups,
                         const std::vector<const Law*>& laws, const std::vector<double>& goals,
                         int threads, const RunLimits& limits, SweepProgress& progress) {
  std::vector<Press> presses(setups.size());
  for_each_run(setups.size(), threads, progress, [&](std::size_t i, ContactRecorder& recorder) {
    EffortWatch watch(row_count(*setups[i]), goals[i]);
    presses[i].outcome =
        measure_run(*setups[i], *laws[i], limits, recorder, progress.cancelled, watch);
    presses[i].effort = watch.effort();
  });
  return presses;
}

}  // namespace ebac
