#pragma once

#include <algorithm>
#include <array>
#include <variant>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

/// Velocity from quantised positions. An estimator is its parameters; its memory is
/// `VelocityState`.
namespace ebac {

/// v = dx / dt: no lag, one count of noise.
struct BackwardDifference {
  static constexpr auto fields() { return std::array<Field<BackwardDifference>, 0>{}; }
};

/// Backward difference through a first-order low-pass.
struct LowPass {
  double time_constant = 5e-3;  // s

  static constexpr auto fields() {
    using F = Field<LowPass>;
    return std::array{
        F{"time_constant", &LowPass::time_constant, "s", "time constant of the filter", 0, 1}};
  }
};

/// First-order adaptive windowing (Janabi-Sharifi, Hayward, Chen 2000): the longest window whose
/// end-to-end line passes within `band` counts of every reading in it.
struct AdaptiveWindow {
  static constexpr int kCapacity = 32;
  int longest = 16;   // samples
  double band = 1.0;  // counts

  static constexpr auto fields() {
    using F = Field<AdaptiveWindow>;
    return std::array{
        F{"longest", &AdaptiveWindow::longest, "samples", "longest window", 1, kCapacity - 1},
        F{"band", &AdaptiveWindow::band, "counts", "largest distance of a reading from the line",
          0.5, 100},
    };
  }
};

using Velocity = std::variant<BackwardDifference, LowPass, AdaptiveWindow>;

/// The last readings of one position, newest first.
class Readings {
 public:
  void clear() EBAC_RT { size_ = 0; }
  void push(double x, double t) EBAC_RT {
    head_ = (head_ + kMask) & kMask;
    x_[head_] = x;
    t_[head_] = t;
    if (size_ < AdaptiveWindow::kCapacity) ++size_;
  }
  int size() const EBAC_RT { return size_; }
  double x(int back) const EBAC_RT { return x_[slot(back)]; }
  double t(int back) const EBAC_RT { return t_[slot(back)]; }

 private:
  static constexpr unsigned kMask = AdaptiveWindow::kCapacity - 1;
  static_assert((AdaptiveWindow::kCapacity & kMask) == 0);
  unsigned slot(int back) const EBAC_RT { return (head_ + static_cast<unsigned>(back)) & kMask; }

  std::array<double, AdaptiveWindow::kCapacity> x_{};
  std::array<double, AdaptiveWindow::kCapacity> t_{};
  unsigned head_ = 0;
  int size_ = 0;
};

/// Slope of the longest window of `readings` whose line keeps within `tolerance` of every reading.
/// Lines from the newest reading that pass all bands form a cone of slopes, which only narrows: one
/// pass.
inline double adaptive_slope(const Readings& readings, int longest, double tolerance) EBAC_RT {
  const int last = std::min(longest, readings.size() - 1);
  double slope = 0;
  double low = kAnyLow;
  double high = kAnyHigh;
  for (int n = 1; n <= last; ++n) {
    const double span = readings.t(0) - readings.t(n);
    if (!(span > 0)) break;
    const double rise = readings.x(0) - readings.x(n);
    const double candidate = rise / span;
    if (candidate < low || candidate > high) break;
    slope = candidate;
    low = std::max(low, (rise - tolerance) / span);
    high = std::min(high, (rise + tolerance) / span);
  }
  return slope;
}

/// Memory of one estimator.
struct VelocityState {
  double v = 0;
  double t = 0;
  Readings readings{};

  /// Takes position `x` that lies `dx` from the last one, `dt` later; `count` is the encoder's
  /// step.
  double update(const Velocity& estimator, double x, double dx, double dt, double count) EBAC_RT {
    if (!(dt > 0)) {
      t = v = 0;
      readings.clear();
      if (std::holds_alternative<AdaptiveWindow>(estimator)) readings.push(x, t);
    } else if (const auto* low_pass = std::get_if<LowPass>(&estimator)) {
      v += (dx / dt - v) * dt / (low_pass->time_constant + dt);
    } else if (const auto* window = std::get_if<AdaptiveWindow>(&estimator)) {
      t += dt;
      readings.push(x, t);
      v = adaptive_slope(readings, window->longest, window->band * count);
    } else {
      v = dx / dt;
    }
    return v;
  }
};

}  // namespace ebac
