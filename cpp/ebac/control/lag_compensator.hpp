#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "ebac/control/contact_estimator.hpp"
#include "ebac/control/ebac_params.hpp"
#include "ebac/control/injection.hpp"
#include "ebac/control/recovery.hpp"
#include "ebac/core/controller.hpp"

namespace ebac {

/// A linear lag compensator with a virtual damper: the stiffness c_h at once, all of the wall
/// through a lag. In each tick of a contact, with dF_e the change of the world's force,
///
///   F_d += clamp(dF_e, -c_h |dx|, c_h |dx|)              the part shown at once,
///   F_d += (F_e - F_d) dt/(tau + dt),                    the rest through the lag,
///   F    = max(0, F_d + B_v v)                           towards the wall it never sticks.
///
/// On a spring wall F_e = K x with K >= c_h this is F_d/F_e = (1 + tau s c_h/K)/(1 + tau s): gain 1
/// at rest, c_h/K in fast motion, whatever K is. On a wall softer than c_h it is the wall itself.
/// tau = T_r max(K/c_h - 1, 1/4), with K the slope seen in this contact, keeps the corner of the
/// zero below the bandwidth on any wall. c_h, B_v and T_r are those of `Ebac` where no resonance is declared.
///
/// Known weakness: no account, no bound and no guard: nothing limits the energy it gives out.
class LagCompensator {
 public:
  static constexpr std::string_view kName = "lag-compensator";
  static constexpr std::string_view kSummary =
      "stiffness c_h at once, the wall through a lag, a virtual damper";
  static constexpr bool kPassive = false;

  struct Params {
    double stiffness = 3.8e3;       // N/m
    double virtual_damping = 32.6;  // N s/m
    double recovery_time = 0.118;   // s
    double count = 3.07e-5;         // m
    double peak_force = 42.4;       // N

    static Params design(const DeviceFacts& facts, const Timing& timing) {
      const Injection show(facts.mass, facts.count, facts.current_lag, timing);
      return {
          .stiffness = show.stiffness,
          .virtual_damping = show.damping,
          .recovery_time = Recovery::time(EbacParams{}.heaviest_hand + facts.mass, show.damping),
          .count = facts.count,
          .peak_force = facts.peak_force};
    }
    static constexpr auto fields() {
      using F = Field<Params>;
      return std::array{
          F{"stiffness", &Params::stiffness, "N/m", "stiffness shown at once, c_h", 1, 1e6},
          F{"virtual_damping", &Params::virtual_damping, "N s/m",
            "virtual damping in contact, B_v; 0 for none", 0, 1e4},
          F{"recovery_time", &Params::recovery_time, "s",
            "T_r: the lag is T_r (K/c_h - 1) for a wall of K, and T_r/4 at least", 1e-3, 10},
          F{"count", &Params::count, "m", "one encoder count at the handle", 0, 0.01},
          F{"peak_force", &Params::peak_force, "N", "largest command", 1e-3, 1e4},
      };
    }
  };

  struct State {
    double f_d = 0;       // N
    double injected = 0;  // N
    double slope = 0;     // N/m

    static constexpr auto fields() {
      using F = Field<State>;
      return std::array{
          F{"f_d", &State::f_d, "N", "lagged force of the wall, F_d"},
          F{"injected", &State::injected, "N", "force of the virtual damper"},
          F{"slope", &State::slope, "N/m", "stiffness of the wall as seen, K"},
      };
    }
  };

  explicit LagCompensator(const Params& params, const Timing& timing = {})
      : params_(checked(params, "LagCompensator")),
        timing_(checked(timing, "Timing")),
        recovery_(params.recovery_time, params.stiffness),
        damper_(params.virtual_damping, Injection::smoothing(timing)) {
    reset();
  }

  double step(const Port& port) EBAC_RT {
    if (!(port.dt > 0)) return 0;
    if (port.dt != dt_) damper_.set_tick(dt_ = port.dt);
    const double damping = damper_.step(port);
    const double change = port.f_env - std::exchange(last_env_, port.f_env);
    contact_.watch(port, /*direction=*/0);
    if (port.f_env == 0) {
      state_ = {};
      return 0;
    }
    state_.slope = contact_.slope_at_rest();
    const double most = params_.stiffness * std::abs(port.dx);
    state_.f_d += std::clamp(change, -most, most);
    state_.f_d += (port.f_env - state_.f_d) * recovery_.share(state_.slope, 1, port.dt);
    const double sign = port.f_env > 0 ? 1 : -1;
    const double towards = sign * (state_.f_d + damping);
    const double command = sign * std::clamp(towards, 0.0, params_.peak_force);
    state_.injected = command - state_.f_d;
    return command;
  }

  /// The force of the last tick has changed by `change` [N] without a motion.
  void shift(double change) EBAC_RT {
    if (last_env_ == 0) return;
    contact_.shift(change);
    last_env_ += change;
    state_.f_d += change;
  }
  /// The world has become `by` times as stiff without a motion.
  void scale(double by) EBAC_RT {
    contact_.scale(by);
    last_env_ *= by;
    state_.f_d *= by;
  }
  void retune(const LagCompensator& next) EBAC_RT {
    params_ = next.params_;
    recovery_ = next.recovery_;
    damper_.retune(params_.virtual_damping);
  }
  void reset() EBAC_RT {
    damper_.reset();
    contact_ = ContactEstimator(params_.count, std::numeric_limits<double>::infinity());
    dt_ = last_env_ = 0;
    state_ = {};
  }
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  Params params_;
  Timing timing_;
  Recovery recovery_;
  Damper damper_;
  ContactEstimator contact_{0, 0};
  double dt_ = 0;        // s
  double last_env_ = 0;  // N
  State state_{};
};

static_assert(Controller<LagCompensator>);

}  // namespace ebac
