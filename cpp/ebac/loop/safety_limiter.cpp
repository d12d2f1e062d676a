#include "ebac/loop/safety_limiter.hpp"

#include <algorithm>
#include <cmath>

namespace ebac {

namespace {

int bit(Limited why) EBAC_RT { return static_cast<int>(why); }

}  // namespace

SafetyLimiter::SafetyLimiter(const Limits& limits, const DeviceModel& device, double dt)
    : on_(true),
      limits_(limits),
      dt_(dt),
      travel_(travel(device.kinematics)),
      shorter_(shorter_ways(device.kinematics)),
      count_(device.facts().count) {
  // Nothing to hold motion and force against.
  if (!device.sensor.fitted) limits_.watch_force = limits_.watch_motion = false;
  check_limits(limits);
  check_ways(limits, device);
  for (int i = 0; i < device.axes(); ++i) {
    amp_per_newton_[i] = 1 / device.force(1, i);
    balance_[static_cast<std::size_t>(i)] = BalanceFacts::of(device, limits.unexplained, dt, i);
  }
  thermal_.fill(Thermal(limits.continuous_current, limits.thermal_time));
}

Fault SafetyLimiter::find(const Reading& reading, const Instant& now, std::span<const Axis> axes,
                          double starved) EBAC_RT {
  overruns_ = now.skipped > 0 ? overruns_ + 1 : 0;
  lost_ = std::max(0.0, lost_ - limits_.pause * now.dt) + lost(now);  // forgotten in a second
  Fault found = motion(reading, now.dt, axes);
  if (found == Fault::kNone && limits_.watch_force) found = sensor(reading);
  const bool late = overruns_ >= limits_.overruns || lost_ > limits_.pause;
  if (found == Fault::kNone && late) found = Fault::kOverruns;
  if (found == Fault::kNone && starved > limits_.starved) found = Fault::kStarved;
  return found;
}

int SafetyLimiter::less(std::span<Axis> axes, double gain, double elapsed) EBAC_RT {
  int limited = gain < 1 ? bit(Limited::kRamp) : 0;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    Joint& joint = axes[i].joint;
    if (on_) {
      const double before = last_[i];
      thermal_[i].heat(before, elapsed);
      joint.current = held(i, gain * (joint.current + edge(i, joint, limited)), before, limited);
      last_[i] = joint.current;
    } else if (gain != 1) {
      joint.current *= gain;
    }
  }
  return limited;
}

void SafetyLimiter::shut(std::span<Axis> axes, double elapsed) EBAC_RT {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    axes[i].joint.current = 0;
    if (on_) thermal_[i].heat(last_[i], elapsed);
    last_[i] = 0;
    state_[i] = {.heat = thermal_[i].heat(), .ceiling = 0};
  }
}

Fault SafetyLimiter::motion(const Reading& reading, double elapsed,
                            std::span<const Axis> axes) EBAC_RT {
  Fault found = Fault::kNone;
  const auto note = [&](bool bad, Fault fault) EBAC_RT {
    if (bad && (found == Fault::kNone || fault < found)) found = fault;
  };
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Joint& joint = axes[i].joint;
    const auto e = static_cast<Eigen::Index>(i);
    const double since = elapsed + counts_age_[i] - reading.counts_age[i];  // s, for this way
    const double way = limits_.jump * std::max(1.0, since / dt_);
    note(moved_ && std::abs(travel_[e] * (joint.q - q_[i])) > way, Fault::kEncoderJump);
    note(fast(i, joint.q, since), Fault::kOverspeed);
    note(std::abs(travel_[e] * joint.q) > limits_.end - shorter_[e], Fault::kWorkspace);
    q_[i] = joint.q;
    counts_age_[i] = reading.counts_age[i];
  }
  moved_ = true;
  return found;
}

/// Whether an axis is too fast, over kSpan at least: a tick may be short, and readings are quantised.
bool SafetyLimiter::fast(std::size_t i, double q, double since) EBAC_RT {
  span_[i] += since;
  if (moved_ && span_[i] < kSpan) return false;
  const double way = std::abs(travel_[static_cast<Eigen::Index>(i)] * (q - from_[i]));
  const bool found = moved_ && way > limits_.speed * span_[i] + count_;
  from_[i] = q;
  span_[i] = 0;
  return found;
}

Fault SafetyLimiter::sensor(const Reading& reading) const EBAC_RT {
  if (reading.force_status == SensorStatus::kDisconnected) return Fault::kForceDisconnected;
  if (reading.force_status == SensorStatus::kSaturated) return Fault::kForceSaturated;
  if (reading.force_status != SensorStatus::kGood) return Fault::kForceError;
  const bool fresh = reading.force_age <= limits_.force_age;  // not so for NaN
  return fresh ? Fault::kNone : Fault::kForceStale;
}

/// Current of the soft wall at the edge of the workspace [A]; it pushes inwards only.
double SafetyLimiter::edge(std::size_t axis, const Joint& joint, int& limited) const EBAC_RT {
  const auto i = static_cast<Eigen::Index>(axis);
  const double x = travel_[i] * joint.q;
  const double depth = std::abs(x) - (limits_.edge - shorter_[i]);
  if (!(depth > 0)) return 0;
  const double side = x > 0 ? 1 : -1;
  const double v = side * travel_[i] * joint.dq;
  const double push = limits_.edge_stiffness * depth + limits_.edge_damping * v;
  limited |= bit(Limited::kEdge);
  return side * std::max(push, 0.0) * amp_per_newton_[i];
}

double SafetyLimiter::held(std::size_t i, double wanted, double before, int& limited) EBAC_RT {
  const double cool = thermal_[i].allowed(dt_);
  const double ceiling = std::min(cool, limits_.peak_current);
  state_[i] = {.heat = thermal_[i].heat(), .ceiling = ceiling};
  if (!std::isfinite(wanted)) {
    limited |= bit(Limited::kNotFinite);
    return 0;
  }
  const double step = limits_.slew * dt_;
  const double slow = std::clamp(wanted, before - step, before + step);
  if (slow != wanted) limited |= bit(Limited::kSlew);
  const double value =
      std::clamp(slow, -ceiling, ceiling);  // the thermal limit has priority over the slew limit
  if (value != slow)
    limited |= bit(cool < limits_.peak_current ? Limited::kThermal : Limited::kPeak);
  return value;
}

}  // namespace ebac
