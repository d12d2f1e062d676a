#include "ebac/faults/referee.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ebac/canopen/cob_id.hpp"

namespace ebac::faults {

namespace {

constexpr double kRoom = 1.01;     // of a limit
constexpr double kPause = 0.0105;  // s, from which on the force must come in anew
constexpr double kStill = 0.02;    // m/s, outwards or slower inwards
constexpr double kDeep = 1e-3;     // m, over the edge
constexpr double kPull = 0.1;      // of the continuous current: noise of a law
constexpr int kTicksPressed = 5;   // until a law has seen the wall
constexpr int kTicksToOff = 3;     // from one drive that is off to no current in any
constexpr int kTicksToStop = 8;    // from a speed or a place that is a fault to drives that are off
constexpr double kFastOrFar = 1.1;  // of a limit: no doubt

}  // namespace

Referee::Referee(const CaseSetup& made, const InjectedFault& injected)
    : injected_(&injected),
      limits_(made.limits),
      dt_(made.setup.timing.dt),
      soft_start_(made.plan.soft_start),
      ramp_down_(injected.at_once() ? 0 : made.plan.ramp_down),
      law_ticks_(made.plan.ticks),
      newton_per_amp_(made.setup.device.force(1)),
      longest_gap_(2 * made.watching.beat) {
  const Motor& motor = made.setup.device.motor;
  full_ = std::min(made.setup.device.drive.peak_ratio * motor.rated_torque / motor.torque_constant,
                   motor.stall_current);
  if (const auto* wall = std::get_if<Wall>(&made.setup.environment)) wall_ = *wall;
  grain_ = motor.rated_torque / motor.torque_constant / 1000;
}

void Referee::hear(const can::Frame& frame) EBAC_RT {
  if (frame.id > can::heartbeat(0)) heard_ = true;
  for (std::size_t i = 0; i < kMaxAxes; ++i) {
    if (frame.id != can::rpdo(1, static_cast<can::NodeId>(i + 1))) continue;
    const double torque = can::get<std::int16_t>(frame.bytes(), 2);
    note(Rule::kNotEnabled, !were_ && torque != 0, torque * grain_, 0, i);
  }
}

void Referee::note(Rule rule, bool broken, double value, double bound, std::size_t axis) EBAC_RT {
  if (!broken || breach_.rule != Rule::kNone) return;
  breach_ = {rule, value, bound, axis, injected_->tick};
}

/// Which drives are on; and the loop's sign of life.
void Referee::power(std::span<const Seen> axes) EBAC_RT {
  all_ = std::ranges::all_of(axes, &Seen::enabled);
  const auto asked = static_cast<double>(injected_->tick - injected_->last_asked);
  // A drive in fault is found while arming, and the law is asked for zero force in the stop.
  const bool arming = !were_ && injected_->kind != Kind::kFaultAtStart;
  note(Rule::kEarlyLaw, arming && injected_->last_asked >= 0, asked, 0, 0);
  if (all_ && !were_) let_in_ = injected_->tick;
  were_ = were_ || all_;
  some_off_ = were_ && !all_ ? some_off_ + 1 : 0;
}

void Referee::currents(double elapsed, const Seen& seen, std::size_t i) EBAC_RT {
  Axis& axis = axis_[i];
  const double size = std::abs(seen.current);
  axis.most = std::max(axis.most, injected_->asks_against() ? seen.current : -seen.current);
  note(Rule::kNotEnabled, !were_ && size > 0, size, 0, i);
  const double share = axis.before / limits_.continuous_current;
  const double decay = std::exp(-elapsed / limits_.thermal_time);
  axis.heat = share * share + (axis.heat - share * share) * decay;
  if (!injected_->strains()) {
    note(Rule::kPeak, size > limits_.peak_current + grain_, size, limits_.peak_current, i);
    const double step = std::abs(seen.current - axis.before);
    const bool less = seen.current * axis.before >= 0 && size <= std::abs(axis.before);
    note(Rule::kSlew, !less && step > limits_.slew * dt_ + 2 * grain_, step / dt_, limits_.slew, i);
    note(Rule::kHeat, axis.heat > kRoom, axis.heat, 1, i);
    note(Rule::kOthersOff, some_off_ > kTicksToOff && size > 0, size, 0, i);
    const double gain = static_cast<double>(injected_->tick - let_in_) * dt_ / soft_start_;
    const double most = std::min(gain, 1.0) * full_;
    const bool inside = std::abs(seen.x) < limits_.edge;
    note(Rule::kSoftStart, inside && gain < 1 && size > kRoom * most + grain_, size, most, i);
  }
  axis.before = seen.current;
}

/// A stop that somebody asked for leaves no current behind its ramp.
void Referee::stopped(const Seen& seen, std::size_t i) EBAC_RT {
  if (injected_->kind != Kind::kStop || injected_->tick < injected_->at) return;
  const double since = static_cast<double>(injected_->tick - injected_->at - kTicksToOff) * dt_;
  const double size = std::abs(seen.current);
  note(Rule::kStopped, since > ramp_down_ && size > grain_, size, grain_, i);
}

/// Too fast for three ticks, or too far: the drives must be off soon.
void Referee::motion(const Seen& seen, std::size_t i) EBAC_RT {
  Axis& axis = axis_[i];
  axis.fast = std::abs(seen.v) > kFastOrFar * limits_.speed ? axis.fast + 1 : 0;
  const bool far = std::abs(seen.x) > limits_.end + kDeep;
  if (axis.out > 0 || axis.fast >= 3 || far) ++axis.out;
  if (!all_) axis.out = axis.fast = 0;
  const bool late = axis.out > kTicksToStop;
  note(Rule::kSpeed, late && !far, std::abs(seen.v), limits_.speed, i);
  note(Rule::kWorkspace, late && far, std::abs(seen.x), limits_.end, i);
}

/// Over the edge, a handle that does not come back feels half of the soft wall at least.
void Referee::soft_wall(const Seen& seen, std::size_t i) EBAC_RT {
  Axis& axis = axis_[i];
  const double side = seen.x > 0 ? 1 : -1;
  const double depth = std::abs(seen.x) - limits_.edge;
  const double least = std::min(depth, axis.depth);
  axis.depth = depth;
  const std::int64_t passed = injected_->tick - let_in_;
  const bool running = all_ && static_cast<double>(passed) * dt_ > soft_start_ + 5 * dt_ &&
                       passed < law_ticks_ && std::abs(seen.x) < limits_.end;
  const bool deep = least > kDeep && side * seen.v > -kStill;
  const double must = 0.5 * limits_.edge_stiffness * least / newton_per_amp_;
  const double inwards = side * seen.current;
  note(Rule::kSoftWall, running && deep && inwards < must, inwards, must, i);
}

/// Until something goes wrong, a virtual wall never pulls the handle that is in it.
void Referee::direction(std::span<const Seen> axes) EBAC_RT {
  if (!wall_ || axes.size() != 2 || injected_->tick >= injected_->at) return;
  const double depth = wall_->depth({axes[0].x, axes[1].x, 0});
  const double passed = static_cast<double>(injected_->tick - let_in_) * dt_;
  pressed_ = all_ && passed > soft_start_ && depth > kDeep ? pressed_ + 1 : 0;
  const double most = kPull * limits_.continuous_current;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double into = -axes[i].current;
    note(Rule::kDirection, pressed_ > kTicksPressed && into > most, into, most, i);
  }
}

void Referee::watch(double elapsed, std::span<const Seen> axes) EBAC_RT {
  power(axes);
  // A pause ends in this tick, whose command is zero: it comes to the drives in the next one.
  if (lets_in_next_) let_in_ = injected_->tick;
  lets_in_next_ = were_ && elapsed > kPause;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    currents(elapsed, axes[i], i);
    stopped(axes[i], i);
    motion(axes[i], i);
    if (!asks_all(injected_->kind)) soft_wall(axes[i], i);
  }
  gap_ = std::exchange(heard_, false) ? 0 : gap_ + elapsed;
  direction(axes);
  note(Rule::kHeartbeat, gap_ > longest_gap_, gap_, longest_gap_, 0);
}

void Referee::finish() EBAC_RT {
  const bool held = injected_->kind == Kind::kForceHeld || injected_->kind == Kind::kForceAtStart;
  const double least = 0.9 * limits_.continuous_current;
  const double most = axis_[injected_->axis].most;
  note(Rule::kWithheld, held && most < least, most, least, injected_->axis);
}

}  // namespace ebac::faults
