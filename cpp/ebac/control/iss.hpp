#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "ebac/control/injection.hpp"
#include "ebac/core/controller.hpp"

namespace ebac {

/// An input-to-state stable approach after Jafari, Nabeel and Ryu (2017): the port need not be
/// passive, as long as what it gives out is bounded by the size of its input. In each contact, with
/// F_M the force of the hand, the input of the port,
///
///   E_k     = sum (F_applied dx + (b/T) dx^2),           port work and damping of the device,
///   E_k    >= -gamma max_{j <= k} F_M,j^2,               criterion,
///   alpha   = min(-(E_k + gamma max F_M^2) dt/dx^2, alpha_max)     where it is missed, else 0,
///   F       = F_e + alpha dx/dt.
///
/// gamma = 0 without the damping of the device is `PassivityControl` with `per_contact`. The default is
/// gamma = (1 + 2 d) T/(4 b): what a force can give out at most over the ticks for which it is late.
///
/// This is a reading of the idea alone: the paper's text was not at hand. It derives its criterion
/// from an analogy with hysteresis, and neither its supply rate nor its controller is claimed here;
/// the storage E, the quadratic gain, and the damper as the means are decided here.
/// Known weakness: alpha acts on the velocity of whole counts, only once energy is missing.
class Iss {
 public:
  static constexpr std::string_view kName = "iss";
  static constexpr std::string_view kSummary =
      "energy given out bounded by the size of the hand's force, by a capped damper";
  static constexpr bool kPassive = false;

  struct Params {
    double damping = 2.0;        // N s/m
    double gain = 3.75e-4;       // J/N^2
    double most_damping = 32.6;  // N s/m
    double peak_force = 42.4;    // N

    static Params design(const DeviceFacts& facts, const Timing& timing) {
      constexpr double kLeastDamping = 0.01;  // N s/m
      const Injection show(facts.mass, facts.count, facts.current_lag, timing);
      const double damping = std::max(facts.damping, kLeastDamping);
      return {.damping = damping,
              .gain = (1 + 2 * timing.delay) * timing.dt / (4 * damping),
              .most_damping = show.damping,
              .peak_force = facts.peak_force};
    }
    static constexpr auto fields() {
      using F = Field<Params>;
      return std::array{
          F{"damping", &Params::damping, "N s/m", "lower bound of the device's physical damping, b",
            0, 500},
          F{"gain", &Params::gain, "J/N^2", "energy that may be given out per force squared, gamma",
            0, 100},
          F{"most_damping", &Params::most_damping, "N s/m", "largest damping injected, alpha_max",
            0, 1e4},
          F{"peak_force", &Params::peak_force, "N", "largest command", 1e-3, 1e4},
      };
    }
  };

  struct State {
    double energy = 0;  // J
    double input = 0;   // N
    double alpha = 0;   // N s/m
    bool clamped = false;

    static constexpr auto fields() {
      using F = Field<State>;
      return std::array{
          F{"energy", &State::energy, "J", "port work plus damping in this contact"},
          F{"input", &State::input, "N", "largest force of the hand in this contact"},
          F{"alpha", &State::alpha, "N s/m", "damping the controller injects"},
          F{"clamped", &State::clamped, "1", "1 where the controller acts"},
      };
    }
  };

  explicit Iss(const Params& params, const Timing& timing = {})
      : params_(checked(params, "ISS")), timing_(checked(timing, "Timing")) {}

  double step(const Port& port) EBAC_RT {
    if (!(port.dt > 0)) return 0;
    const double v = port.dx / port.dt;
    if (port.f_env == 0) {
      state_ = {};
    } else if (in_contact_) {
      state_.energy += (port.f_applied + params_.damping * v) * port.dx;
    }
    in_contact_ = port.f_env != 0;
    if (!in_contact_) return 0;
    state_.input = std::max(state_.input, std::abs(port.f_meas));
    const double missing = -(state_.energy + params_.gain * state_.input * state_.input);
    state_.alpha = 0;
    if (missing > 0 && port.dx != 0) {
      state_.alpha = std::min(missing / (v * port.dx), params_.most_damping);
    }
    state_.clamped = state_.alpha > 0;
    const double command = port.f_env + state_.alpha * v;
    return std::clamp(command, -params_.peak_force, params_.peak_force);
  }

  void retune(const Iss& next) EBAC_RT { params_ = next.params_; }
  void reset() EBAC_RT {
    in_contact_ = false;
    state_ = {};
  }
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  Params params_;
  Timing timing_;
  bool in_contact_ = false;
  State state_{};
};

static_assert(Controller<Iss>);

}  // namespace ebac
