#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "ebac/control/affordable_force.hpp"
#include "ebac/core/controller.hpp"

namespace ebac {

/// Force bounding (the family of Kim and Ryu's energy-bounding algorithm): the accumulated account
/// alone, F^2 <= 4 B E less the commands in flight. The stiffest of the strictly passive laws.
///
/// Known weakness: the account grows with every motion and is spent at once, so a wall feels
/// bouncy, and its stiffness depends on the past motion.
class ForceBounding {
 public:
  static constexpr std::string_view kName = "force-bounding";
  static constexpr std::string_view kSummary =
      "F^2 <= 4 B E on an accumulated, delay-aware account";
  static constexpr bool kPassive = true;

  struct Params {
    double damping = 2.0;       // N s/m
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
          F{"current_lag", &Params::current_lag, "s", "time constant of the drive's current loop",
            0, 0.1},
          F{"count", &Params::count, "m", "one encoder count at the handle", 0, 0.01},
          F{"peak_force", &Params::peak_force, "N", "largest command", 1e-3, 1e4},
      };
    }
  };

  struct State {
    double account = 0;  // J
    bool clamped = false;

    static constexpr auto fields() {
      using F = Field<State>;
      return std::array{
          F{"account", &State::account, "J", "port work plus damping, on the force really applied"},
          F{"clamped", &State::clamped, "1", "1 where the law gave less than the world asked"},
      };
    }
  };

  explicit ForceBounding(const Params& params, const Timing& timing = {})
      : params_(checked(params, "ForceBounding")),
        timing_(checked(timing, "Timing")),
        account_(params.damping, params.count, params.current_lag, timing) {}

  double step(const Port& port) EBAC_RT {
    if (!(port.dt > 0)) return 0;
    account_.take(port.f_applied, port.dx, port.dt);
    state_.account = account_.energy();
    const double most = std::min(account_.largest(), params_.peak_force);
    const double command = std::clamp(port.f_env, -most, most);
    state_.clamped = command != port.f_env;
    account_.give(command);
    return command;
  }

  void retune(const ForceBounding& next) EBAC_RT { params_ = next.params_; }
  void reset() EBAC_RT {
    account_ = AffordableForce(params_.damping, params_.count, params_.current_lag, timing_);
    state_ = {};
  }
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  Params params_;
  Timing timing_;
  AffordableForce account_;
  State state_{};
};

static_assert(Controller<ForceBounding>);

}  // namespace ebac
