#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <memory>
#include <variant>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

/// Hands beyond eq. (4): how the force of a hand on the handle comes about. A `Hand` with a model
/// keeps its mass, damping, stiffness and path; the model makes the force from them.
namespace ebac {

struct Hand;

/// What a hand feels and wants along one axis at an instant.
struct HandMotion {
  double t = 0;       // s
  double x = 0;       // m, handle
  double v = 0;       // m/s, handle
  double target = 0;  // m, where the hand wants to be, X0
};

/// Continuous states a hand may have of its own on an axis; they are integrated with the device.
inline constexpr int kHandStates = 5;
using HandState = Eigen::Matrix<double, kHandStates, 1>;
using HandStates = Eigen::Matrix<double, kHandStates, kMaxAxes>;

/// What moves with the handle, and what the step of the integration is chosen from.
struct HandBounds {
  double mass = 0;       // kg, moves with the handle
  double damping = 0;    // N s/m, largest between hand and handle
  double stiffness = 0;  // N/m, largest between hand and handle
  double rate = 0;       // 1/s, fastest of its own states
};

/// The force of a hand on one axis: the base class of a hand of your own. Nothing that is called in
/// a run throws, blocks or allocates. The force may depend on time, motion and own state; within a
/// step of the integration it is asked for several times and instants, so only `advance` may change
/// the object.
class HandForce {
 public:
  virtual ~HandForce() = default;

  /// Force on the handle [N], along +x, without that of a mass that moves with the handle.
  virtual double force(const HandMotion& at, const HandState& state) const EBAC_RT = 0;

  /// How its own states change [per s]; they start at zero.
  virtual HandState rate(const HandMotion&, const HandState&) const EBAC_RT {
    return HandState::Zero();
  }

  /// A step of the integration has ended; time only rises here.
  virtual void advance(const HandMotion&) EBAC_RT {}

  /// By default what `hand` declares.
  virtual HandBounds bounds(const Hand& hand) const;

  /// Force at rest, after infinite time [N]; NaN where there is none.
  virtual double steady(double /*target*/, double /*x*/) const {
    return std::numeric_limits<double>::quiet_NaN();
  }

  /// A copy, with its state.
  virtual std::unique_ptr<HandForce> clone() const = 0;
  /// Called once before a run, on the copy for this axis.
  virtual void start(int /*axis*/) {}
};

/// A stretch reflex on top of eq. (4): muscle force answers the motion of `delay` ago, through
/// the activation of the muscle, a low-pass of second order.
///
///   F = K0 (X0 - x) - B0 v - M0 a + r
///   r'' = w^2 (u - r) - 2 z w r'
///   u(t) = stretch_gain K0 (X0 - x(t - delay)) - velocity_gain B0 v(t - delay)
///
/// Structure: van der Helm et al., J. Neurosci. Methods 119 (2002); activation (16.8 rad/s, 0.99):
/// Mugge et al. 2010, as tabulated in PMC5664365, table 1. Delay and gains: from memory of the first,
/// where the velocity gain is about the arm's own damping and the delay 25 to 50 ms.
struct Reflex {
  double delay = 0.04;         // s
  double stretch_gain = 0.25;  // 1
  double velocity_gain = 1;    // 1
  double activation = 2.7;     // Hz
  double activation_damping = 0.99;

  static constexpr auto fields() {
    using F = Field<Reflex>;
    return std::array{
        F{"delay", &Reflex::delay, "s", "time from stretch to muscle", 5e-3, 0.5},
        F{"stretch_gain", &Reflex::stretch_gain, "1", "stiffness of the reflex, as a share of K0",
          0, 10},
        F{"velocity_gain", &Reflex::velocity_gain, "1", "damping of the reflex, as a share of B0",
          0, 10},
        F{"activation", &Reflex::activation, "Hz", "natural frequency of the muscle's activation",
          0.1, 50},
        F{"activation_damping", &Reflex::activation_damping, "1",
          "damping ratio of the muscle's activation", 0.1, 10},
    };
  }
};

/// The pulp of the fingers between handle and hand: an exponential spring that relaxes (quasilinear
/// viscoelastic). Mass, damper and spring of eq. (4) act on the bone behind it, at y:
///
///   F_e(d) = sign(d) stiffness / rise (exp(rise |d|) - 1) with d = y - x, linear from `stiffest` on
///   F = F_e - sum of c_i z_i,  z_i' = (F_e - z_i) / tau_i
///   M0 y'' = K0 (X0 - y) - B0 y' - F
///
/// The form and tau = 4 ms, 70 ms, 1.4 s: Pawluk and Howe, J. Biomech. Eng. 121 (1999) 178-183,
/// 0 to 2 N in compression. Stiffness, rise and shares: from memory of it; that a held handle is
/// pushed and pulled alike and that the spring goes on above 2 N are assumptions.
struct FingerPad {
  double stiffness = 200;  // N/m
  double rise = 2000;      // 1/m
  double stiffest = 20e3;  // N/m
  double fast = 0.3;       // 1
  double medium = 0.2;     // 1
  double slow = 0.1;       // 1

  static constexpr std::array<double, 3> kTau{4e-3, 70e-3, 1.4};  // s

  static constexpr auto fields() {
    using F = Field<FingerPad>;
    return std::array{
        F{"stiffness", &FingerPad::stiffness, "N/m", "stiffness at no force", 1, 1e5},
        F{"rise", &FingerPad::rise, "1/m", "growth of the stiffness with the force", 1, 1e4},
        F{"stiffest", &FingerPad::stiffest, "N/m", "largest stiffness", 1, 1e6},
        F{"fast", &FingerPad::fast, "1", "share of the force that relaxes within 4 ms", 0, 0.3},
        F{"medium", &FingerPad::medium, "1", "share that relaxes within 70 ms", 0, 0.3},
        F{"slow", &FingerPad::slow, "1", "share that relaxes within 1.4 s", 0, 0.3},
    };
  }
};

/// A hand that stiffens with its own force: dF/dx = K0 (1 + |F| / force), at most `stiffest` K0, and
/// B0 with the square root of it, so that the damping ratio stays.
///
///   F = sign(e) force (exp(K0 |e| / force) - 1) - B v - M0 a,  e = X0 - x
///
/// Stiffness grows linearly with the force of the grip: Van Doren, Motor Control 2 (1998) 352-378;
/// Hoeppner et al., PLOS ONE 8 (2013) e80889; damping grows too: Hasser and Cutkosky 2002, Hajian
/// and Howe 1997. The numbers are indicative: twice as stiff at 20 N.
struct NonlinearGrip {
  double force = 20;    // N
  double stiffest = 3;  // 1

  static constexpr auto fields() {
    using F = Field<NonlinearGrip>;
    return std::array{
        F{"force", &NonlinearGrip::force, "N", "force at which the hand is twice as stiff", 0.1,
          1e3},
        F{"stiffest", &NonlinearGrip::stiffest, "1", "largest stiffness, in multiples of K0", 1,
          100},
    };
  }
};

/// A hand that opens at `open_at` and grips again at `closed_at`, every `period`. Between its body
/// (mass, damper and spring of eq. (4), at y) and the handle is the grip; its share s goes from 1 to
/// 0 and back within `ramp`, along a minimum-jerk path. An open hand follows the handle, so that it
/// grips where the handle then is.
///
///   F = s (stiffness (y - x) + damping (y' - x'))
///   M0 y'' = s K0 (X0 - y) + (1 - s) K0 (x - y) - B0 y' - F
///
/// Stiffness and damping of the grip are indicative (the range of Hajian and Howe 1997 for one
/// finger, 255 to 1255 N/m, for several in parallel).
struct LetGo {
  double open_at = 2;                                       // s
  double closed_at = 2.5;                                   // s
  double period = std::numeric_limits<double>::infinity();  // s
  double ramp = 0.03;                                       // s
  double stiffness = 3000;                                  // N/m
  double damping = 10;                                      // N s/m

  static constexpr auto fields() {
    using F = Field<LetGo>;
    return std::array{
        F{"open_at", &LetGo::open_at, "s", "when the hand starts to open", 0, 1e6},
        F{"closed_at", &LetGo::closed_at, "s", "when it starts to grip again", 0, 1e6},
        F{"period", &LetGo::period, "s", "how often; inf for once", 1e-2},
        F{"ramp", &LetGo::ramp, "s", "time to open, and to close", 1e-3, 1},
        F{"stiffness", &LetGo::stiffness, "N/m", "stiffness of the closed grip", 1, 1e6},
        F{"damping", &LetGo::damping, "N s/m", "damping of the closed grip", 0, 1e4},
    };
  }
};

/// A hand of your own; its mass (moves with the handle), damping and stiffness (the largest of its
/// force) stand in the `Hand`.
struct OwnHand {
  std::shared_ptr<const HandForce> force;
};

/// No model is eq. (4) itself.
using HandModel = std::variant<std::monostate, Reflex, FingerPad, NonlinearGrip, LetGo, OwnHand>;

/// The force that a hand's model makes; null for eq. (4). Throws std::invalid_argument for a model
/// that does not fit the hand.
std::unique_ptr<HandForce> hand_force(const Hand& hand, int axis);

/// One `HandForce` per axis; none for eq. (4).
class HandForces {
 public:
  HandForces() = default;
  HandForces(const Hand& hand, int axes);
  HandForces(const HandForces& other);
  HandForces(HandForces&&) noexcept = default;
  HandForces& operator=(HandForces other) noexcept {
    axis_.swap(other.axis_);
    return *this;
  }
  ~HandForces() = default;

  explicit operator bool() const EBAC_RT { return axis_[0] != nullptr; }
  const HandForce& operator[](int axis) const EBAC_RT {
    return *axis_[static_cast<std::size_t>(axis)];
  }
  HandForce& operator[](int axis) EBAC_RT { return *axis_[static_cast<std::size_t>(axis)]; }

 private:
  std::array<std::unique_ptr<HandForce>, kMaxAxes> axis_{};
};

}  // namespace ebac
