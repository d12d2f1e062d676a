#pragma once

#include <cmath>
#include <cstdint>

#include "ebac/core/clock.hpp"
#include "ebac/model/linear_flow.hpp"
#include "ebac/model/noise.hpp"

namespace ebac {

/// Virtual time: t = k T, or with jitter t = (k + e) T, |e| <= jitter, in whole quanta.
class VirtualClock {
 public:
  VirtualClock(double dt, double jitter, std::uint64_t seed) EBAC_RT : dt_(dt),
                                                                       jitter_(jitter),
                                                                       random_(seed, /*stream=*/1) {
  }

  Instant wait() EBAC_RT {
    if (!(jitter_ > 0)) return on_time();
    const std::int64_t late =
        tick_ > 0 ? static_cast<std::int64_t>(
                        std::floor(jitter_ * random_.symmetric() * static_cast<double>(kQuanta)))
                  : 0;
    const std::int64_t now = tick_ * kQuanta + late;
    const std::int64_t passed = now - last_;
    last_ = now;
    ++tick_;
    return {seconds(now), seconds(passed), seconds(late)};
  }

 private:
  /// Without jitter the same comes to less.
  Instant on_time() EBAC_RT {
    const double dt = tick_ > 0 ? dt_ : 0.0;
    return {.t = dt_ * static_cast<double>(tick_++), .dt = dt};
  }
  double seconds(std::int64_t quanta) const EBAC_RT {
    return dt_ * (static_cast<double>(quanta) / static_cast<double>(kQuanta));
  }

  double dt_;
  double jitter_;  // of a tick
  Noise random_;
  std::int64_t tick_ = 0;
  std::int64_t last_ = 0;
};

static_assert(Clock<VirtualClock>);

}  // namespace ebac
