#pragma once

#include <array>
#include <limits>
#include <memory>
#include <variant>
#include <vector>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/model/hand_model.hpp"

/// The operator of eq. (4), (5): a mass, a damper and a spring pulled towards an intended path
/// X0(t). On the device acts F_h = K0 (X0 - x) - B0 v - M0 a, unless a model makes another force of
/// them.
namespace ebac {

/// Wants to be at `target` from time `at` on.
struct Step {
  double target = 0.04;  // m
  double at = 0;         // s

  double position(double t) const EBAC_RT { return t >= at ? target : 0.0; }

  static constexpr bool kContinuous = false;
  static constexpr auto fields() {
    using F = Field<Step>;
    return std::array{F{"target", &Step::target, "m", "where the hand wants to be", -10, 10},
                      F{"at", &Step::at, "s", "from when on", 0, 1e6}};
  }
};

/// Reaches `target` along the smoothest path (Flash and Hogan 1985).
struct MinimumJerk {
  double target = 0.04;   // m
  double at = 0;          // s
  double duration = 0.5;  // s

  double position(double t) const EBAC_RT {
    const double s = (t - at) / duration;
    if (!(s > 0)) return 0;
    return s < 1 ? target * s * s * s * (10 + s * (6 * s - 15)) : target;
  }

  static constexpr bool kContinuous = true;
  static constexpr auto fields() {
    using F = Field<MinimumJerk>;
    return std::array{F{"target", &MinimumJerk::target, "m", "where the movement ends", -10, 10},
                      F{"at", &MinimumJerk::at, "s", "when it starts", 0, 1e6},
                      F{"duration", &MinimumJerk::duration, "s", "how long it takes", 1e-3, 1e6}};
  }
};

struct Sine {
  double centre = 0.02;     // m
  double amplitude = 0.02;  // m
  double frequency = 1;     // Hz
  double phase = 0;         // rad

  double position(double t) const EBAC_RT;

  static constexpr bool kContinuous = true;
  static constexpr auto fields() {
    using F = Field<Sine>;
    return std::array{F{"centre", &Sine::centre, "m", "middle of the swing", -10, 10},
                      F{"amplitude", &Sine::amplitude, "m", "half of the swing", 0, 10},
                      F{"frequency", &Sine::frequency, "Hz", "swings a second", 0, 500},
                      F{"phase", &Sine::phase, "rad", "angle at time zero", -10, 10}};
  }
};

/// Square tapping: half a period at `target`, half a period at `rest`.
struct Tapping {
  double target = 0.04;    // m
  double rest = -0.01;     // m
  double frequency = 1.5;  // Hz

  double position(double t) const EBAC_RT;

  static constexpr bool kContinuous = false;
  static constexpr auto fields() {
    using F = Field<Tapping>;
    return std::array{F{"target", &Tapping::target, "m", "where it taps", -10, 10},
                      F{"rest", &Tapping::rest, "m", "where it lifts to", -10, 10},
                      F{"frequency", &Tapping::frequency, "Hz", "taps a second", 1e-3, 100}};
  }
};

/// A path from a log: straight between its points, constant beyond its ends.
class Recorded {
 public:
  /// `t` [s] must rise strictly, `x` [m] has as many values; throws std::invalid_argument
  /// otherwise.
  Recorded(std::vector<double> t, std::vector<double> x);

  double position(double t) const EBAC_RT;
  const std::vector<double>& t() const { return points_->t; }
  const std::vector<double>& x() const { return points_->x; }

  static constexpr bool kContinuous = true;

 private:
  struct Points {
    std::vector<double> t, x;
  };
  std::shared_ptr<const Points> points_;  // shared, so that a hand stays cheap to copy
};

using Path = std::variant<Step, MinimumJerk, Sine, Tapping, Recorded>;

/// Where a path is at the start of an interval, and its slope over it: a target enters the plant as
/// a ramp.
struct Target {
  double x = 0;     // m
  double rate = 0;  // m/s
};

struct Hand {
  double mass = 0.15;      // kg
  double damping = 6;      // N s/m
  double stiffness = 300;  // N/m
  std::array<Path, kMaxAxes> path{Step{}, Step{.target = 0}, Step{.target = 0}};
  double tremor_amplitude = 0;                                  // m
  double tremor_frequency = 9;                                  // Hz
  double release_at = std::numeric_limits<double>::infinity();  // s
  HandModel model{};                                            // none: eq. (4)

  /// The intended path of one axis over [t, t + dt], tremor on top.
  Target target(int axis, double t, double dt) const EBAC_RT {
    const auto* step = std::get_if<Step>(&path[static_cast<std::size_t>(axis)]);
    if (step != nullptr && !(tremor_amplitude > 0)) return {.x = step->position(t)};
    return moving_target(axis, t, dt);
  }

  /// Another target [m], from now on, in place of the path of that axis; a recorded one stays: its
  /// points cannot be freed within a tick.
  void aim(std::size_t axis, double target) EBAC_RT {
    if (!std::holds_alternative<Recorded>(path[axis])) path[axis] = Step{.target = target};
  }

  Target moving_target(int axis, double t, double dt) const EBAC_RT;
  /// What is on top of the path of every axis.
  Sine tremor() const EBAC_RT {
    return {.centre = 0, .amplitude = tremor_amplitude, .frequency = tremor_frequency};
  }

  /// Whether its force is that of eq. (4).
  bool linear() const EBAC_RT { return std::holds_alternative<std::monostate>(model); }

  /// Force with which the hand pulls at time t, |K0 (X0 - x)| [N]: the part of eq. (4) that can
  /// give energy without end. 0 once it let go.
  double pull(int axis, double t, double x) const EBAC_RT;

  static constexpr auto fields() {
    using F = Field<Hand>;
    return std::array{
        F{"mass", &Hand::mass, "kg", "mass of the hand, which moves with the handle: M0 of eq. (4)",
          0, 10},
        F{"damping", &Hand::damping, "N s/m", "damping of the hand, force per speed: B0 of eq. (4)",
          0, 1e3},
        F{"stiffness", &Hand::stiffness, "N/m",
          "stiffness of the hand, force per distance from its target: K0 of eq. (4)", 0, 1e5},
        F{"tremor_amplitude", &Hand::tremor_amplitude, "m",
          "tremor on top of the path, on every axis", 0, 0.1},
        F{"tremor_frequency", &Hand::tremor_frequency, "Hz", "frequency of the tremor", 0, 500},
        F{"release_at", &Hand::release_at, "s", "when the hand lets go; inf for never", 0},
    };
  }
};

}  // namespace ebac
