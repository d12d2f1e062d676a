#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "ebac/core/controller.hpp"

namespace ebac {

/// Passivity observer and controller (Hannaford and Ryu 2002): watch the energy at the port, and
/// where it falls below its reference, dissipate the shortfall with a variable damper alpha.
///
/// The observer is the exact account W = sum F_applied dx. The reference is zero, or, as a variant,
/// the energy that the environment itself would store, int F_e dx over the contact. With `per_contact` the
/// account starts anew with each contact, so that energy taken in by one cannot be given out by the
/// next. alpha is capped: uncapped it diverges on a sampled, delayed device. A cap of 0.9 is a
/// published choice; B_v / b, the virtual damping that mass and delay allow (`Injection`), is the
/// largest sensible one, 16 on the reference device. Known weakness: it acts only once energy is
/// missing, and with the cap it may not suffice.
class PassivityControl {
 public:
  static constexpr std::string_view kName = "passivity-control";
  static constexpr std::string_view kSummary = "passivity observer and capped passivity controller";
  static constexpr bool kPassive = false;

  struct Params {
    double damping = 2.0;  // N s/m
    double cap = 0.9;
    bool reference = false;
    bool per_contact = false;
    double peak_force = 42.4;  // N

    static constexpr Params design(const DeviceFacts& facts, Timing) {
      return {.damping = facts.damping, .peak_force = facts.peak_force};
    }
    static constexpr auto fields() {
      using F = Field<Params>;
      return std::array{
          F{"damping", &Params::damping, "N s/m", "lower bound of the device's physical damping, b",
            0, 500},
          F{"cap", &Params::cap, "1", "largest alpha over the device's damping", 0, 100},
          F{"reference", &Params::reference, "1",
            "hold to the energy the environment stores instead of to zero", 0, 1},
          F{"per_contact", &Params::per_contact, "1", "begin the account anew with each contact", 0,
            1},
          F{"peak_force", &Params::peak_force, "N", "largest command", 1e-3, 1e4},
      };
    }
  };

  struct State {
    double observed = 0;   // J
    double reference = 0;  // J
    double alpha = 0;      // N s/m
    bool clamped = false;

    static constexpr auto fields() {
      using F = Field<State>;
      return std::array{
          F{"observed", &State::observed, "J", "energy taken in at the port"},
          F{"reference", &State::reference, "J", "energy it is held to"},
          F{"alpha", &State::alpha, "N s/m", "damping the controller injects"},
          F{"clamped", &State::clamped, "1", "1 where the controller acts"},
      };
    }
  };

  explicit PassivityControl(const Params& params, const Timing& timing = {})
      : params_(checked(params, "PassivityControl")), timing_(checked(timing, "Timing")) {}

  double step(const Port& port) EBAC_RT {
    if (!(port.dt > 0)) return 0;
    observe(port);
    const double missing = state_.reference - state_.observed;
    state_.alpha = 0;
    if (missing > 0 && port.dx != 0) {
      const double needed = missing * port.dt / (port.dx * port.dx);
      state_.alpha = std::min(needed, params_.cap * params_.damping);
    }
    state_.clamped = state_.alpha > 0;
    const double command = port.f_env + state_.alpha * port.dx / port.dt;
    return std::clamp(command, -params_.peak_force, params_.peak_force);
  }

  void retune(const PassivityControl& next) EBAC_RT { params_ = next.params_; }
  void reset() EBAC_RT {
    state_ = {};
    last_env_ = 0;
  }
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  void observe(const Port& port) EBAC_RT {
    state_.observed += port.f_applied * port.dx;
    if (params_.per_contact && last_env_ == 0 && port.f_env != 0)
      state_.observed = state_.reference = 0;
    if (params_.reference) {
      state_.reference += 0.5 * (port.f_env + last_env_) * port.dx;
      if (port.f_env == 0) {  // contact over: whatever is left over is not saved for the next one
        state_.reference = 0;
        state_.observed = std::min(state_.observed, 0.0);
      }
    }
    last_env_ = port.f_env;
  }

  Params params_;
  Timing timing_;
  double last_env_ = 0;  // N
  State state_{};
};

static_assert(Controller<PassivityControl>);

}  // namespace ebac
