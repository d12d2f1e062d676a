#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>

#include "ebac/core/clock.hpp"
#include "ebac/core/device.hpp"
#include "ebac/loop/impulse_balance.hpp"
#include "ebac/model/limits.hpp"
#include "ebac/model/thermal.hpp"

namespace ebac {

/// The last stage before the drives: limits each current, reports the reason, and finds conditions
/// of the device that must end the run. `watch` is called after the law, `limit` last.
class SafetyLimiter {
 public:
  /// Columns of a trace, per axis.
  struct State {
    double heat = 0;     // relative to that of the continuous current
    double ceiling = 0;  // A
    static constexpr auto fields() {
      using F = Field<State>;
      return std::array{
          F{"heat", &State::heat, "1",
            "heat of the winding (i2t) over that of its continuous current"},
          F{"ceiling", &State::ceiling, "A", "largest current allowed in this tick"},
      };
    }
  };
  static constexpr std::string_view kPrefix = "limit.";

  SafetyLimiter() = default;
  /// Throws std::invalid_argument for limits out of range. `dt` is the sample time [s].
  SafetyLimiter(const Limits& limits, const DeviceModel& device, double dt);

  bool on() const EBAC_RT { return on_; }

  /// What encoder, force sensor and motor are held against, if they are.
  std::optional<AllBalanceFacts> watches_motion() const {
    return on_ && limits_.watch_motion ? std::optional(balance_) : std::nullopt;
  }

  /// Returns the fault, if any, in the motion, the force sensor or the timing of the device, or of a
  /// law that has been `starved` too long [s].
  Fault watch(const Reading& reading, const Instant& now, std::span<const Axis> axes,
              double starved = 0) EBAC_RT {
    return on_ ? find(reading, now, axes, starved) : Fault::kNone;
  }

  /// Whether the loop paused for so long before this tick that its force must come in anew.
  bool paused(const Instant& now) const EBAC_RT {
    return on_ && kAnew * lost(now) >= limits_.pause;
  }

  /// Limits the currents; `gain` in [0, 1] is that of soft start and stop. Returns the bits of
  /// `Limited` that apply.
  int limit(std::span<Axis> axes, double gain, double elapsed) EBAC_RT {
    return on_ || gain != 1 ? less(axes, gain, elapsed) : 0;
  }

  /// Sets all currents to zero at once.
  void shut(std::span<Axis> axes, double elapsed) EBAC_RT;

  /// Resets everything but the temperature of the motors.
  void restart() EBAC_RT {
    last_ = {};
    overruns_ = 0;
    lost_ = 0;
    moved_ = false;
  }

  const State& state(std::size_t axis) const EBAC_RT { return state_[axis]; }

 private:
  Fault find(const Reading& reading, const Instant& now, std::span<const Axis> axes,
             double starved) EBAC_RT;
  int less(std::span<Axis> axes, double gain, double elapsed) EBAC_RT;
  Fault motion(const Reading& reading, double elapsed, std::span<const Axis> axes) EBAC_RT;
  bool fast(std::size_t i, double q, double since) EBAC_RT;
  Fault sensor(const Reading& reading) const EBAC_RT;
  double edge(std::size_t axis, const Joint& joint, int& limited) const EBAC_RT;
  double held(std::size_t i, double wanted, double before, int& limited) EBAC_RT;
  double lost(const Instant& now) const EBAC_RT { return dt_ * static_cast<double>(now.skipped); }

  static constexpr double kSpan = 0.9e-3;  // s
  static constexpr double kAnew = 5;

  bool on_ = false;
  Limits limits_{};
  double dt_ = 1e-3;                    // s
  Axes travel_ = Axes::Ones();          // m, way of each axis per joint angle
  Axes shorter_ = Axes::Zero();         // m, by which its stops lie before those of the first
  double count_ = 0;                    // m, of the encoder
  Axes amp_per_newton_ = Axes::Ones();  // A/N
  std::array<Thermal, kMaxAxes> thermal_{};
  std::array<double, kMaxAxes> last_{};        // A, of the last tick
  std::array<double, kMaxAxes> q_{};           // rad, of the last tick
  std::array<double, kMaxAxes> counts_age_{};  // s, of the last tick
  std::array<double, kMaxAxes> from_{};        // rad, where the span began
  std::array<double, kMaxAxes> span_{};        // s
  std::array<State, kMaxAxes> state_{};
  AllBalanceFacts balance_{};
  bool moved_ = false;
  int overruns_ = 0;  // samples in a row
  double lost_ = 0;   // s, by late ticks
};

}  // namespace ebac
