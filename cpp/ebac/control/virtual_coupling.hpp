#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "ebac/core/concepts.hpp"

namespace ebac {

/// A virtual coupling (Colgate, Stanley, Brown 1995; Adams and Hannaford 1999): a spring K_c and a
/// damper B_c between the device and a proxy that stays on the surface of the virtual object. The
/// force of the virtual world is never exceeded, so a soft wall is rendered as it is and a stiff
/// one as K_c.
///
/// K_c and B_c are the stiffest that Llewellyn's condition allows on a frequency grid up to
/// Nyquist. Known weakness: on a wall stiffer than K_c the device rests too deep, by design.
class VirtualCoupling {
 public:
  static constexpr std::string_view kName = "virtual-coupling";
  static constexpr std::string_view kSummary = "spring and damper to a proxy on the surface";
  static constexpr bool kPassive = false;

  struct Params {
    double coupling_stiffness = 2e3;  // N/m
    double coupling_damping = 1;      // N s/m
    double peak_force = 42.4;         // N

    static Params design(const DeviceFacts& facts, Timing timing);

    static constexpr auto fields() {
      using F = Field<Params>;
      return std::array{
          F{"coupling_stiffness", &Params::coupling_stiffness, "N/m", "K_c", 0, 1e7},
          F{"coupling_damping", &Params::coupling_damping, "N s/m", "B_c", 0, 1e4},
          F{"peak_force", &Params::peak_force, "N", "largest command", 1e-3, 1e4},
      };
    }
  };

  struct State {
    double proxy = 0;  // m
    bool clamped = false;

    static constexpr auto fields() {
      using F = Field<State>;
      return std::array{
          F{"proxy", &State::proxy, "m", "where the proxy stands"},
          F{"clamped", &State::clamped, "1", "1 where the coupling gave less than the world asked"},
      };
    }
  };

  explicit VirtualCoupling(const Params& params, const Timing& timing = {})
      : params_(checked(params, "VirtualCoupling")), timing_(checked(timing, "Timing")) {}

  double step(const Port& port) EBAC_RT {
    if (port.f_env == 0) {  // out of contact the proxy goes with the device
      state_ = {.proxy = port.x, .clamped = false};
      return 0;
    }
    const double pull =
        params_.coupling_stiffness * (port.x - state_.proxy) + params_.coupling_damping * port.v;
    const double most = std::min(std::abs(port.f_env), params_.peak_force);
    const double sign = port.f_env > 0 ? 1 : -1;
    const double command = sign * std::clamp(sign * pull, 0.0, most);
    state_.clamped = command != port.f_env;
    return command;
  }
  void retune(const VirtualCoupling& next) EBAC_RT { params_ = next.params_; }
  void reset() EBAC_RT { state_ = {}; }
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  Params params_;
  Timing timing_;
  State state_{};
};

static_assert(Controller<VirtualCoupling>);

}  // namespace ebac
