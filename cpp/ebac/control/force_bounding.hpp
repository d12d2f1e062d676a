#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "ebac/control/energy_ledger.hpp"
#include "ebac/control/pending.hpp"
#include "ebac/core/concepts.hpp"

namespace ebac {

/// Force bounding (the family of Kim and Ryu's energy-bounding algorithm): the accumulated account
/// alone, F^2 <= 4 B E less what is under way. The stiffest of the strictly passive laws.
///
/// Known weakness: the account grows with every motion and is spent at once, so a wall feels
/// bouncy, and how stiff it is depends on what happened before.
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
        b_(params.damping / timing.longest()),
        ledger_(params.damping, params.count, params.current_lag, 0),
        pending_(timing.delay) {}

  double step(const Port& port) EBAC_RT {
    if (!(port.dt > 0)) return 0;
    if (port.dt != dt_) set_tick(port.dt);
    ledger_.take(port.f_applied, port.dx);
    state_.account = ledger_.energy();
    const double under_way = pending_.sum_of_squares() + ledger_.tail_squared();
    const double most = std::min(covered_force(state_.account - under_way / (4 * b_), b_,
                                               params_.count, pending_.largest_with(0)),
                                 params_.peak_force);
    const double command = std::clamp(port.f_env, -most, most);
    state_.clamped = command != port.f_env;
    pending_.push(command);
    return command;
  }

  void reset() EBAC_RT {
    ledger_ = EnergyLedger(params_.damping, params_.count, params_.current_lag, 0);
    pending_ = Pending(timing_.delay);
    dt_ = 0;
    state_ = {};
  }
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  void set_tick(double dt) EBAC_RT {
    dt_ = dt;
    ledger_.set_tick(dt);
  }

  Params params_;
  Timing timing_;
  double b_;  // N/m, B = b/T over the longest tick a force may act for
  EnergyLedger ledger_;
  Pending pending_;
  double dt_ = 0;
  State state_{};
};

static_assert(Controller<ForceBounding>);

}  // namespace ebac
