#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "ebac/core/device_facts.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/core/sample.hpp"

namespace ebac {

/// What the ports have surely taken in and damped, whatever the law: `work`, `unsure` and `damped`
/// of every axis.
class EnergyAccount {
 public:
  explicit EnergyAccount(const DeviceFacts& facts) EBAC_RT : damping_(std::max(0.0, facts.damping)),
                                                             half_count_(facts.count / 2) {}

  /// `dt` is the time since the last tick, 0 in the first.
  void set_tick(double dt) EBAC_RT { b_ = dt > 0 ? damping_ / dt : 0.0; }

  /// The interval that ended with this tick, without the static compensation in the applied force; with the estimate of
  /// the observer where there is one.
  void take(std::span<Axis> axes, const std::array<double, kMaxAxes>& given_back,
            bool observed) EBAC_RT {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      Port& port = axes[i].port;
      const double f = port.f_applied - given_back[i];
      const double bound = observed ? port.est.bound : half_count_;
      // By summation by parts: what the last position leaves open, and every change of the force.
      changes_[i] += bound_[i] * std::abs(f - acted_[i]);
      acted_[i] = f;
      bound_[i] = bound;
      port.unsure = changes_[i] + bound * std::abs(f);
      if (observed) {
        port.work += f * port.est.dx;
        port.damped += damping_ * port.dt * port.est.v * port.est.v;
      } else {
        const double sure = std::max(std::abs(port.dx) - 2 * half_count_, 0.0);
        port.work += f * port.dx;
        port.damped += b_ * sure * sure;
      }
    }
  }

 private:
  double damping_;                          // N s/m, lower bound of the device's own damping
  double half_count_;                       // m
  double b_ = 0;                            // N/m, B = b/T
  std::array<double, kMaxAxes> acted_{};    // N, force of the last interval
  std::array<double, kMaxAxes> bound_{};    // m, error of the last position
  std::array<double, kMaxAxes> changes_{};  // J, of `unsure`, without the present force
};

}  // namespace ebac
