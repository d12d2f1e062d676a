#pragma once

#include <array>
#include <cmath>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// A first-order lag over a step of `z` time constants, free of cancellation however small z is:
/// decay = exp(-z), phi[k] = int_0^1 exp(-z (1 - s)) s^k / k! ds.
struct LagStep {
  double z;
  double decay;
  std::array<double, 3> phi{};

  explicit LagStep(double steps) EBAC_RT : z(steps), decay(std::exp(-steps)) {
    constexpr double kSmall = 0.5;  // below, the closed forms lose digits and eleven terms suffice
    if (z < kSmall) {
      double sum = 0;
      for (int k = 13; k > 3; --k) sum = (1 - z * sum) / k;
      phi[2] = (1 - z * sum) / 6;
      phi[1] = 0.5 - z * phi[2];
      phi[0] = 1 - z * phi[1];
    } else {
      phi[0] = (1 - decay) / z;
      phi[1] = (1 - phi[0]) / z;
      phi[2] = (0.5 - phi[1]) / z;
    }
  }
};

/// Value in the middle of a step of the parabola that has these ends and this mean.
template <class T>
T middle(const T& start, const T& end, const T& mean) EBAC_RT {
  return (6 * mean - start - end) / 4;
}

/// Output at the end of a step of a lag whose input is the parabola through start, middle and end.
/// Exact, so the lag may be far shorter than the step.
template <class T>
T follow(const LagStep& step, const T& output, const T& start, const T& mid, const T& end) EBAC_RT {
  const T slope = 4 * mid - 3 * start - end;
  const T bend = 2 * (start + end) - 4 * mid;
  return step.decay * output +
         step.z * (step.phi[0] * start + step.phi[1] * slope + 2 * step.phi[2] * bend);
}

}  // namespace ebac
