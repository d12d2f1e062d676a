#pragma once

#include <array>
#include <string_view>

#include "ebac/control/affordable_force.hpp"
#include "ebac/control/eba.hpp"
#include "ebac/core/controller.hpp"

namespace ebac {

/// The energy-bounding algorithm with an account behind it: the force is bounded by `Eba`, and by
/// what an account of the force really applied can pay for over any motion, with all commands in
/// flight (D). The account holds for every history, delay, lag and encoder declared; the stated
/// passivity rests on it.
class EbaAccount {
 public:
  static constexpr std::string_view kName = "eba-account";
  static constexpr std::string_view kSummary = "eba, held to an account of the energy at the port";
  static constexpr bool kPassive = true;

  struct Params {
    double damping = 2.0;  // N s/m
    double share = 1.0;
    double current_lag = 3e-4;  // s
    double count = 3.07e-5;     // m
    double peak_force = 42.4;   // N

    static constexpr Params design(const DeviceFacts& facts, Timing) {
      return {.damping = facts.damping,
              .current_lag = facts.current_lag,
              .count = facts.count,
              .peak_force = facts.peak_force};
    }
    static constexpr auto fields() {
      using F = Field<Params>;
      return std::array{
          F{"damping", &Params::damping, "N s/m", "lower bound of the device's physical damping, b",
            0.01, 500},
          F{"share", &Params::share, "1", "c over its largest value 2 b / ((1 + 2 d) T)", 1e-3, 1},
          F{"current_lag", &Params::current_lag, "s", "time constant of the drive's current loop",
            0, 0.1},
          F{"count", &Params::count, "m", "one encoder count at the handle", 0, 0.01},
          F{"peak_force", &Params::peak_force, "N", "largest command", 1e-3, 1e4},
      };
    }
  };

  struct State : Eba::State {
    double account = 0;  // J

    static constexpr auto fields() {
      using F = Field<State>;
      return std::array{
          beta_field<State>(),
          beta_min_field<State>(),
          beta_max_field<State>(),
          F{"account", &State::account, "J", "port work plus damping, on the force really applied"},
          F{"clamped", &State::clamped, "1", "1 where the law gave less than the world asked"},
      };
    }
  };

  explicit EbaAccount(const Params& params, const Timing& timing = {})
      : params_(checked(params, "EBAAccount")),
        timing_(checked(timing, "Timing")),
        law_({.damping = params.damping, .share = params.share, .peak_force = params.peak_force},
             timing),
        account_(params.damping, params.count, params.current_lag, timing) {}

  double step(const Port& port) EBAC_RT {
    if (!(port.dt > 0)) return 0;
    account_.take(port.f_applied, port.dx, port.dt);
    const double command = law_.step(port, account_.largest());  // (D)
    state_ = {{law_.state()}, account_.energy()};
    account_.give(command);
    return command;
  }

  void retune(const EbaAccount& next) EBAC_RT {
    params_ = next.params_;
    law_.retune(next.law_);
  }
  void reset() EBAC_RT {
    account_ = AffordableForce(params_.damping, params_.count, params_.current_lag, timing_);
    law_.reset();
    state_ = {};
  }
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  Params params_;
  Timing timing_;
  Eba law_;
  AffordableForce account_;
  State state_{};
};

static_assert(Controller<EbaAccount>);

}  // namespace ebac
