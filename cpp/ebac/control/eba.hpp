#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "ebac/control/beta.hpp"
#include "ebac/core/controller.hpp"

namespace ebac {

/// The energy-bounding algorithm of Kim and Ryu, eq. (8), (9), alone: the storage F^2/(2c) never
/// grows by more than port work and damping (E). Quiet on any wall and too soft by design, because
/// its stiffness tends to c = 2 b / ((1 + 2 d) T), with the longest T where there is jitter.
///
/// The bound is proven without delay, lag and encoder; with them c is reduced and nothing is proven.
/// `EbaAccount` adds an account that holds with all three.
class Eba {
 public:
  static constexpr std::string_view kName = "eba";
  static constexpr std::string_view kSummary = "eq. (8), (9) with the state-dependent energy bound";
  static constexpr bool kPassive = false;

  struct Params {
    double damping = 2.0;  // N s/m
    double share = 1.0;
    double peak_force = 42.4;  // N

    static constexpr Params design(const DeviceFacts& facts, Timing) {
      return {.damping = facts.damping, .peak_force = facts.peak_force};
    }
    static constexpr auto fields() {
      using F = Field<Params>;
      return std::array{
          F{"damping", &Params::damping, "N s/m", "lower bound of the device's physical damping, b",
            0.01, 500},
          F{"share", &Params::share, "1", "c over its largest value 2 b / ((1 + 2 d) T)", 1e-3, 1},
          F{"peak_force", &Params::peak_force, "N", "largest command", 1e-3, 1e4},
      };
    }
  };

  struct State : BetaTrace {
    bool clamped = false;

    static constexpr auto fields() {
      using F = Field<State>;
      return std::array{
          beta_field<State>(),
          beta_min_field<State>(),
          beta_max_field<State>(),
          F{"clamped", &State::clamped, "1", "1 where the law gave less than the world asked"},
      };
    }
  };

  explicit Eba(const Params& params, const Timing& timing = {})
      : params_(checked(params, "EBA")),
        timing_(checked(timing, "Timing")),
        c_(params.share * 2 * params.damping / timing.longest() / (1 + 2 * timing.delay)) {}

  double step(const Port& port) EBAC_RT {
    return step(port, std::numeric_limits<double>::infinity());
  }

  /// The same, with a force of at most `affordable` [N].
  double step(const Port& port, double affordable) EBAC_RT {
    if (!(port.dt > 0)) return 0;
    const double before = command_;
    const double stored =
        energy_bound_squared(before, port.dx, c_, params_.damping / port.dt);  // (E)
    const double bound = std::min(std::sqrt(stored), affordable);
    const double most = std::min(bound, params_.peak_force);
    command_ = std::clamp(port.f_env, -most, most);  // eq. (8), (9), bounded
    state_.clamped = command_ != port.f_env;
    state_.record(before, command_, port.dx, bound);
    return command_;
  }

  void retune(const Eba& next) EBAC_RT {
    params_ = next.params_;
    c_ = next.c_;
  }
  void reset() EBAC_RT {
    command_ = 0;
    state_ = {};
  }
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  Params params_;
  Timing timing_;
  double c_;            // N/m
  double command_ = 0;  // F_d(t-1)
  State state_{};
};

static_assert(Controller<Eba>);

}  // namespace ebac
