#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "ebac/core/controller.hpp"

namespace ebac {

/// No law: the command is the force of the virtual world.
class Direct {
 public:
  static constexpr std::string_view kName = "direct";
  static constexpr std::string_view kSummary = "no law: the command is what the virtual world asks";
  static constexpr bool kPassive = false;

  struct Params {
    double peak_force = 42.4;  // N

    static constexpr Params design(const DeviceFacts& facts, Timing) {
      return {.peak_force = facts.peak_force};
    }
    static constexpr auto fields() {
      using F = Field<Params>;
      return std::array{F{"peak_force", &Params::peak_force, "N", "largest command", 1e-3, 1e4}};
    }
  };

  struct State {
    static constexpr auto fields() { return std::array<Field<State>, 0>{}; }
  };

  explicit Direct(const Params& params, const Timing& timing = {})
      : params_(checked(params, "Direct")), timing_(checked(timing, "Timing")) {}

  double step(const Port& port) EBAC_RT {
    return std::clamp(port.f_env, -params_.peak_force, params_.peak_force);
  }
  void retune(const Direct& next) EBAC_RT { params_ = next.params_; }
  void reset() EBAC_RT {}
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  Params params_;
  Timing timing_;
  State state_{};
};

static_assert(Controller<Direct>);

}  // namespace ebac
