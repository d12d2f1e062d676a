#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "ebac/core/controller.hpp"

namespace ebac {

/// Successive force augmentation (Singh, Jafari and Ryu 2019): a feedback force of low stiffness K_l
/// and, on top of it, a force offset that successive reversals of the motion raise towards the force
/// of the virtual world. In each tick of a contact, with dF_e the change of the world's force,
///
///   F_l += clamp(dF_e, -K_l |dx|, K_l |dx|),                             feedback, at most K_l,
///   F_o += g (F_e - F_l - F_o)    where releasing turns into pressing,   offset,
///   F    = F_l + F_o, towards the wall it never sticks.
///
/// With `transient` the world's own stiffness is rendered until the first reversal, and the offset
/// begins there with what is missing: the extension of the paper for a higher rate-hardness.
///
/// This is a reading of the paper's abstract, which names the low stiffness, the feed-forward offset
/// and the transient; its text was not at hand. Decided here: the offset moves by a share g of what
/// is missing, at the shallow end of each swing, so that what it adds is pressed against before it
/// pushes back (raised at the deep end too, it gives out energy in every swing and shakes for ever);
/// and K_l is 2 b/((1 + 2 d) T), the largest passive stiffness. Known weakness: a hand that does not
/// swing meets K_l alone, and nothing watches the energy an offset gives out.
class Sfa {
 public:
  static constexpr std::string_view kName = "sfa";
  static constexpr std::string_view kSummary =
      "low stiffness plus a force offset raised at each reversal of motion";
  static constexpr bool kPassive = false;

  struct Params {
    double stiffness = 1.3e3;  // N/m
    double gain = 0.2;
    bool transient = false;
    double count = 3.07e-5;    // m
    double peak_force = 42.4;  // N

    static constexpr Params design(const DeviceFacts& facts, const Timing& timing) {
      const double passive = 2 * facts.damping / ((1 + 2 * timing.delay) * timing.dt);
      return {.stiffness = std::max(passive, 1.0),
              .count = facts.count,
              .peak_force = facts.peak_force};
    }
    static constexpr auto fields() {
      using F = Field<Params>;
      return std::array{
          F{"stiffness", &Params::stiffness, "N/m", "stiffness of the feedback force, K_l", 1, 1e6},
          F{"gain", &Params::gain, "1", "share of the missing force added at a reversal, g", 0, 1},
          F{"transient", &Params::transient, "1", "render the wall itself until the first reversal",
            0, 1},
          F{"count", &Params::count, "m", "one encoder count at the handle", 0, 0.01},
          F{"peak_force", &Params::peak_force, "N", "largest command", 1e-3, 1e4},
      };
    }
  };

  struct State {
    double feedback = 0;  // N
    double offset = 0;    // N

    static constexpr auto fields() {
      using F = Field<State>;
      return std::array{
          F{"feedback", &State::feedback, "N", "force of the low stiffness, F_l"},
          F{"offset", &State::offset, "N", "force offset, F_o"},
      };
    }
  };

  explicit Sfa(const Params& params, const Timing& timing = {})
      : params_(checked(params, "SFA")), timing_(checked(timing, "Timing")) {}

  double step(const Port& port) EBAC_RT {
    if (!(port.dt > 0)) return 0;
    const double change = port.f_env - std::exchange(last_env_, port.f_env);
    if (port.f_env == 0) {
      reset();
      return 0;
    }
    const double most = params_.stiffness * std::abs(port.dx);
    state_.feedback += std::clamp(change, -most, most);
    const bool turned = reversed(port.dx);
    const bool pressing = port.dx * port.f_env > 0;
    const double missing = port.f_env - state_.feedback - state_.offset;
    if (params_.transient && !swung_) {
      state_.offset += missing;
    } else if (turned && pressing) {
      state_.offset += params_.gain * missing;
    }
    swung_ = swung_ || turned;
    const double sign = port.f_env > 0 ? 1 : -1;
    const double towards = sign * (state_.feedback + state_.offset);
    return sign * std::clamp(towards, 0.0, params_.peak_force);
  }

  void retune(const Sfa& next) EBAC_RT { params_ = next.params_; }
  void reset() EBAC_RT {
    last_env_ = heading_ = 0;
    swung_ = false;
    state_ = {};
  }
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  /// Whether the motion of this tick is against the last one; less than a count is rounding.
  bool reversed(double dx) EBAC_RT {
    if (std::abs(dx) <= params_.count / 2) return false;
    return dx * std::exchange(heading_, dx) < 0;
  }

  Params params_;
  Timing timing_;
  double last_env_ = 0;  // N
  double heading_ = 0;   // m, last motion
  bool swung_ = false;   // in this contact
  State state_{};
};

static_assert(Controller<Sfa>);

}  // namespace ebac
