#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

#include "ebac/control/contact_estimator.hpp"
#include "ebac/core/controller.hpp"

namespace ebac {

/// A virtual coupling (Colgate, Stanley, Brown 1995; Adams and Hannaford 1999): a spring K_c and a
/// damper B_c in series with the virtual world, between the device and a proxy without mass that
/// obeys the wall. With delta = x - x_proxy,
///
///   K_c delta + B_c d(delta)/dt = F_e(x_proxy) = F_e(x) - K delta,     F = F_e(x) - K delta,
///
/// the derivative backward over the tick. A law is given the force of the world at the device and
/// not the world: K is the slope seen in this contact, so the proxy meets the tangent of the wall.
/// At rest a wall of K is rendered as K_c K/(K_c + K).
///
/// K_c and B_c are the stiffest that Llewellyn's condition allows on a frequency grid up to Nyquist,
/// for any passive world; without delay K_c is nearly Colgate's 2 (b - B_c)/T. Known weakness: the
/// device rests too deep, by design.
class VirtualCoupling {
 public:
  static constexpr std::string_view kName = "virtual-coupling";
  static constexpr std::string_view kSummary =
      "spring and damper in series, to a proxy that obeys the wall";
  static constexpr bool kPassive = false;

  struct Params {
    double coupling_stiffness = 2e3;  // N/m
    double coupling_damping = 1;      // N s/m
    double count = 3.07e-5;           // m
    double peak_force = 42.4;         // N

    static Params design(const DeviceFacts& facts, Timing timing);

    static constexpr auto fields() {
      using F = Field<Params>;
      return std::array{
          F{"coupling_stiffness", &Params::coupling_stiffness, "N/m",
            "stiffness of the spring between handle and proxy: K_c", 0, 1e7},
          F{"coupling_damping", &Params::coupling_damping, "N s/m",
            "damping of the damper between handle and proxy: B_c", 0, 1e4},
          F{"count", &Params::count, "m", "one encoder count at the handle", 0, 0.01},
          F{"peak_force", &Params::peak_force, "N", "largest command", 1e-3, 1e4},
      };
    }
  };

  struct State {
    double proxy = 0;  // m
    double slope = 0;  // N/m
    bool clamped = false;

    static constexpr auto fields() {
      using F = Field<State>;
      return std::array{
          F{"proxy", &State::proxy, "m", "where the proxy stands"},
          F{"slope", &State::slope, "N/m", "stiffness of the wall as seen, K"},
          F{"clamped", &State::clamped, "1", "1 where the coupling gave less than the world asked"},
      };
    }
  };

  explicit VirtualCoupling(const Params& params, const Timing& timing = {})
      : params_(checked(params, "VirtualCoupling")), timing_(checked(timing, "Timing")) {
    reset();
  }

  double step(const Port& port) EBAC_RT {
    if (!(port.dt > 0)) return 0;
    contact_.watch(port, /*direction=*/0);
    if (port.f_env == 0) {  // out of contact the proxy goes with the device
      deflection_ = 0;
      state_ = {.proxy = port.x};
      return 0;
    }
    const double damper = params_.coupling_damping / port.dt;  // N/m
    state_.slope = contact_.slope_at_rest();
    const double all = damper + params_.coupling_stiffness + state_.slope;
    deflection_ = all > 0 ? (damper * deflection_ + port.f_env) / all : 0.0;
    state_.proxy = port.x - deflection_;
    const double sign = port.f_env > 0 ? 1 : -1;
    const double passed = sign * (port.f_env - state_.slope * deflection_);
    const double command = sign * std::clamp(passed, 0.0, params_.peak_force);
    state_.clamped = command != port.f_env;
    return command;
  }
  /// The force of the last tick has changed by `change` [N] without a motion.
  void shift(double change) EBAC_RT { contact_.shift(change); }
  /// The world has become `by` times as stiff without a motion.
  void scale(double by) EBAC_RT { contact_.scale(by); }
  void retune(const VirtualCoupling& next) EBAC_RT { params_ = next.params_; }
  void reset() EBAC_RT {
    contact_ = ContactEstimator(params_.count, std::numeric_limits<double>::infinity());
    deflection_ = 0;
    state_ = {};
  }
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  Params params_;
  Timing timing_;
  ContactEstimator contact_{0, 0};
  double deflection_ = 0;  // m
  State state_{};
};

static_assert(Controller<VirtualCoupling>);

}  // namespace ebac
