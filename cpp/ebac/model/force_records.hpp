#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ebac/core/sample.hpp"
#include "ebac/model/force_sensor.hpp"

namespace ebac {

/// The records of a simulated force sensor that is not prompt: when each was taken, of which force,
/// and how old the last one is. Between two ticks the force is a straight line; it is remembered for
/// as long as the sensor is late.
class ForceRecords {
 public:
  using Forces = std::array<double, kMaxAxes>;

  /// `dt` is the sample time [s]; ticks may be half as long.
  ForceRecords(const ForceSensor& sensor, double dt)
      : past_(std::max(kFewest, 2 * static_cast<std::size_t>(std::ceil(sensor.delay / dt)) + 2)) {}

  /// One tick, at `t` s, with the force behind the sensor's lag [N]. `show(axis, force)` reads it.
  template <class Show>
  void tick(const ForceSensor& sensor, double t, const Forces& force, std::size_t axes,
            Show&& show) EBAC_RT {
    head_ = (head_ + 1) % past_.size();
    past_[head_] = {t, force};
    used_ = std::min(used_ + 1, past_.size());
    const bool stopped = sensor.stopped(t);
    const double latest = sensor.period > 0 ? std::floor(t / sensor.period) * sensor.period : t;
    if (!stopped && (latest > taken_ || used_ == 1)) {
      taken_ = latest;
      for (std::size_t i = 0; i < axes; ++i) show(i, at(taken_ - sensor.delay, i));
    }
    age_ = stopped && sensor.repeats ? 0 : t - taken_;
  }

  double age() const EBAC_RT { return age_; }  // s, as the loop sees it

 private:
  static constexpr std::size_t kFewest = 32;  // ticks
  struct Past {
    double t = 0;
    Forces force{};
  };

  double at(double t, std::size_t axis) const EBAC_RT {
    const std::size_t size = past_.size();
    for (std::size_t back = 0; back + 1 < used_; ++back) {
      const Past& later = past_[(head_ + size - back) % size];
      const Past& earlier = past_[(head_ + size - back - 1) % size];
      if (t < earlier.t) continue;
      const double share = std::clamp((t - earlier.t) / (later.t - earlier.t), 0.0, 1.0);
      return earlier.force[axis] + share * (later.force[axis] - earlier.force[axis]);
    }
    return past_[(head_ + size + 1 - used_) % size].force[axis];
  }

  std::vector<Past> past_;
  std::size_t head_ = 0;
  std::size_t used_ = 0;
  double taken_ = 0;  // s, the last record
  double age_ = 0;    // s
};

}  // namespace ebac
