#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "ebac/control/force_feedback.hpp"
#include "ebac/core/controller.hpp"

namespace ebac {

/// Torque control, eq. (2): feed-forward of the desired force and PD on the measured one.
class Tca {
 public:
  static constexpr std::string_view kName = "tca";
  static constexpr std::string_view kSummary =
      "eq. (2): desired force plus PD feedback of the F/T sensor";
  static constexpr bool kPassive = false;

  struct Params {
    double kp = 0.5;
    double kd = 0;             // s
    double filter = 5e-3;      // s
    double peak_force = 42.4;  // N

    static constexpr Params design(const DeviceFacts& facts, Timing) {
      return {.peak_force = facts.peak_force};
    }
    static constexpr auto fields() {
      using F = Field<Params>;
      return std::array{
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
    double feedback = 0;  // N

    static constexpr auto fields() {
      return std::array{Field<State>{"feedback", &State::feedback, "N", "PD part of eq. (2)"}};
    }
  };

  explicit Tca(const Params& params, const Timing& timing = {})
      : params_(checked(params, "TCA")),
        timing_(checked(timing, "Timing")),
        loop_(params.kp, params.kd, params.filter) {}

  double step(const Port& port) EBAC_RT {
    state_.feedback = loop_.step(port.f_env, port.f_meas, port.dt);
    return std::clamp(port.f_env + state_.feedback, -params_.peak_force, params_.peak_force);
  }
  void retune(const Tca& next) EBAC_RT {
    params_ = next.params_;
    loop_.retune(params_.kp, params_.kd, params_.filter);
  }
  void reset() EBAC_RT {
    loop_.reset();
    state_ = {};
  }
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  Params params_;
  Timing timing_;
  ForceFeedback loop_;
  State state_{};
};

static_assert(Controller<Tca>);

}  // namespace ebac
