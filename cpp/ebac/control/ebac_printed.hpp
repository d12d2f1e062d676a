#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "ebac/control/beta.hpp"
#include "ebac/control/force_feedback.hpp"
#include "ebac/core/controller.hpp"

namespace ebac {

/// Eq. (8) to (10) and (2) taken literally, to show their behaviour. This law neither settles at
/// the wall nor stays passive; `Ebac` is the completed law.
///
/// The paper leaves open the limits and the behaviour at rest: here the limits are the
/// state-dependent bound of Kim and Ryu (or a constant, if requested), and at V_d = 0 the force
/// freezes. Kept as printed: the ratios are not sorted, the continuity rows come after the bound
/// and may leave it, and beta(t-1) = 0 holds beta at zero until the bound (row 1) frees it, so that
/// a soft wall entered from free air is not felt at first.
class EbacPrinted {
 public:
  static constexpr std::string_view kName = "ebac-printed";
  static constexpr std::string_view kSummary = "eq. (8) to (10) and (2), read to the letter";
  static constexpr bool kPassive = false;

  struct Params {
    double damping = 2.0;  // N s/m
    double growth = 1.2;
    double decay = 0.8;
    double constant_limit = 0;  // N/m
    double kp = 0.5;
    double kd = 0;             // s
    double filter = 5e-3;      // s
    double peak_force = 42.4;  // N

    static constexpr Params design(const DeviceFacts& facts, Timing) {
      return {.damping = facts.damping, .peak_force = facts.peak_force};
    }
    static constexpr auto fields() {
      using F = Field<Params>;
      return std::array{
          F{"damping", &Params::damping, "N s/m", "lower bound of the device's physical damping, b",
            0, 500},
          F{"growth", &Params::growth, "1",
            "largest beta, as a multiple of that of the last tick: c1 of eq. (10)", 1, 1.2},
          F{"decay", &Params::decay, "1",
            "smallest beta, as a multiple of that of the last tick: c2 of eq. (10)", 0.8, 1},
          F{"constant_limit", &Params::constant_limit, "N/m",
            "beta_max = -beta_min as a constant; 0 for the bound of Kim and Ryu", 0, 1e7},
          F{"kp", &Params::kp, "1", "gain on the error of the measured force: K_p of eq. (2)", 0,
            10},
          F{"kd", &Params::kd, "s",
            "gain on the rate of the error of the measured force: K_d of eq. (2)", 0, 1},
          F{"filter", &Params::filter, "s", "low-pass on the derivative of the force error", 0, 1},
          F{"peak_force", &Params::peak_force, "N", "largest command", 1e-3, 1e4},
      };
    }
  };

  struct State : BetaTrace {
    double f_d = 0;  // N
    bool clamped = false;

    static constexpr auto fields() {
      using F = Field<State>;
      return std::array{
          beta_field<State>(),
          beta_min_field<State>(),
          beta_max_field<State>(),
          F{"f_d", &State::f_d, "N", "F_d of eq. (8)"},
          F{"clamped", &State::clamped, "1", "1 where eq. (10) changed beta"},
      };
    }
  };

  explicit EbacPrinted(const Params& params, const Timing& timing = {})
      : params_(checked(params, "EBACPrinted")),
        timing_(checked(timing, "Timing")),
        loop_(params.kp, params.kd, params.filter) {}

  double step(const Port& port) EBAC_RT {
    if (port.dx != 0 && port.dt > 0) {
      move(port);
    } else {
      rest();
    }
    const double desired = std::clamp(state_.f_d, -params_.peak_force, params_.peak_force);
    const double command = desired + loop_.step(desired, port.f_meas, port.dt);  // eq. (2)
    return std::clamp(command, -params_.peak_force, params_.peak_force);
  }

  void retune(const EbacPrinted& next) EBAC_RT {
    params_ = next.params_;
    loop_.retune(params_.kp, params_.kd, params_.filter);
  }
  void reset() EBAC_RT {
    loop_.reset();
    state_ = {};
    last_beta_ = kUndefined;
  }
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  void move(const Port& port) EBAC_RT {
    const double asked = (port.f_env - state_.f_d) / port.dx;  // eq. (9), with dx for V_d
    limits(port);
    double beta = asked;  // eq. (10), row by row
    if (beta > state_.beta_max) {
      beta = state_.beta_max;
    } else if (beta < state_.beta_min) {
      beta = state_.beta_min;
    } else if (beta > params_.growth * last_beta_) {  // false while beta(t-1) is undefined
      beta = params_.growth * last_beta_;
    } else if (beta < params_.decay * last_beta_) {
      beta = params_.decay * last_beta_;
    }
    state_.clamped = beta != asked;
    state_.beta = last_beta_ = beta;
    state_.f_d += beta * port.dx;  // eq. (8)
  }

  /// V_d = 0: eq. (9) has no value, and the force freezes.
  void rest() EBAC_RT {
    state_.record(0, 0, 0, 0);
    state_.clamped = false;
  }

  void limits(const Port& port) EBAC_RT {
    if (params_.constant_limit > 0) {
      state_.beta_max = params_.constant_limit;
      state_.beta_min = -params_.constant_limit;
      return;
    }
    const double b = params_.damping / port.dt;
    const double c = 2 * b / (1 + 2 * timing_.delay);
    const double bound = std::sqrt(energy_bound_squared(state_.f_d, port.dx, c, b));
    state_.record(state_.f_d, state_.f_d, port.dx, bound);
  }

  Params params_;
  Timing timing_;
  ForceFeedback loop_;
  double last_beta_ = kUndefined;  // beta(t-1)
  State state_{};
};

static_assert(Controller<EbacPrinted>);

}  // namespace ebac
