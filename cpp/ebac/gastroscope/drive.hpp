#pragma once

#include <algorithm>
#include <cmath>

#include "ebac/core/realtime.hpp"

/// A motor of the slave and the tendons behind it.
namespace ebac::gastroscope {

/// A position loop with a lag, which gets slower with the load and stands still at its limit; a load
/// does not push it back.
struct MotorAxis {
  double at = 0;  // m or rad

  void step(double target, double load, double lag, double fastest, double strongest,
            double dt) EBAC_RT {
    double rate = (target - at) / (lag + dt);
    const double against = rate > 0 ? load : -load;  // load resists a larger value where positive
    const double most = fastest * std::clamp(1 - against / strongest, 0.0, 1.0);
    rate = std::clamp(rate, -most, most);
    at += rate * dt;
  }
};

/// Follows its input at a distance of at most half its width: backlash.
struct Play {
  double at = 0;  // rad

  double follow(double input, double width) EBAC_RT {
    return at = std::clamp(at, input - 0.5 * width, input + 0.5 * width);
  }
};

/// Tendons: slack, and behind it a share that lags by friction (Prandtl-Ishlinskii, of two plays).
struct Tendon {
  Play slack, friction;

  double follow(double motor, double backlash, double share, double width) EBAC_RT {
    const double pulled = slack.follow(motor, backlash);
    return (1 - share) * pulled + share * friction.follow(pulled, width);
  }
};

}  // namespace ebac::gastroscope
