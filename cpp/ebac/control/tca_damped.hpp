#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "ebac/control/force_feedback.hpp"
#include "ebac/control/injection.hpp"
#include "ebac/core/controller.hpp"

namespace ebac {

/// Torque control with a virtual damper B_v in contact, and nothing else: the honest rival. It is
/// designed with the damper of `Ebac` where no resonance is declared, B_v = M_h w; equal to it on
/// moderate walls and faster to settle.
///
/// Known weakness: nothing watches the energy, and the wall is shown at its full stiffness while
/// moving, which a stiffer wall or a longer delay does not forgive.
class TcaDamped {
 public:
  static constexpr std::string_view kName = "tca-damped";
  static constexpr std::string_view kSummary = "eq. (2) plus a virtual damper in contact";
  static constexpr bool kPassive = false;

  struct Params {
    double virtual_damping = 32.6;  // N s/m
    double kp = 0.5;
    double kd = 0;             // s
    double filter = 5e-3;      // s
    double peak_force = 42.4;  // N

    static Params design(const DeviceFacts& facts, const Timing& timing) {
      const Injection show(facts.mass, facts.count, facts.current_lag, timing);
      return {.virtual_damping = show.damping, .peak_force = facts.peak_force};
    }
    static constexpr auto fields() {
      using F = Field<Params>;
      return std::array{
          F{"virtual_damping", &Params::virtual_damping, "N s/m",
            "virtual damping in contact, B_v; 0 for none", 0, 1e4},
          F{"kp", &Params::kp, "1", "gain on the error of the measured force: K_p of eq. (2)", 0,
            10},
          F{"kd", &Params::kd, "s",
            "gain on the rate of the error of the measured force: K_d of eq. (2)", 0, 1},
          F{"filter", &Params::filter, "s", "low-pass on the derivative of the force error", 0, 1},
          F{"peak_force", &Params::peak_force, "N", "largest command", 1e-3, 1e4},
      };
    }
  };

  struct State {
    double injected = 0;  // N
    double feedback = 0;  // N

    static constexpr auto fields() {
      using F = Field<State>;
      return std::array{
          F{"injected", &State::injected, "N", "force of the virtual damper"},
          F{"feedback", &State::feedback, "N", "PD part of eq. (2)"},
      };
    }
  };

  explicit TcaDamped(const Params& params, const Timing& timing = {})
      : params_(checked(params, "TCADamped")),
        timing_(checked(timing, "Timing")),
        damper_(params.virtual_damping, Injection::smoothing(timing)),
        loop_(params.kp, params.kd, params.filter) {}

  double step(const Port& port) EBAC_RT {
    if (!(port.dt > 0)) return 0;
    if (port.dt != dt_) damper_.set_tick(dt_ = port.dt);
    const double damping = damper_.step(port);
    state_.injected = 0;
    double desired = port.f_env;
    if (port.f_env != 0) {
      desired += damping;
      desired = port.f_env > 0 ? std::max(desired, 0.0) : std::min(desired, 0.0);  // never sticks
      state_.injected = desired - port.f_env;
    }
    state_.feedback = loop_.step(desired, port.f_meas, port.dt);
    return std::clamp(desired + state_.feedback, -params_.peak_force, params_.peak_force);
  }

  void retune(const TcaDamped& next) EBAC_RT {
    params_ = next.params_;
    damper_.retune(params_.virtual_damping);
    loop_.retune(params_.kp, params_.kd, params_.filter);
  }
  void reset() EBAC_RT {
    loop_.reset();
    damper_.reset();
    dt_ = 0;
    state_ = {};
  }
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  Params params_;
  Timing timing_;
  Damper damper_;
  ForceFeedback loop_;
  double dt_ = 0;  // s
  State state_{};
};

static_assert(Controller<TcaDamped>);

}  // namespace ebac
