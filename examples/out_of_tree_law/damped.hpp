#pragma once

#include <algorithm>
#include <array>
#include <ebac/core/controller.hpp>
#include <string_view>

/// A law of your own: the world's force plus a virtual damper while in contact.
class Damped {
 public:
  static constexpr std::string_view kName = "damped";
  static constexpr std::string_view kSummary = "the world's force plus a virtual damper in contact";
  static constexpr bool kPassive = false;

  struct Params {
    double virtual_damping = 30;  // N s/m
    double peak_force = 42.4;     // N

    /// From what a user can know about a device, never from the wall.
    static constexpr Params design(const ebac::DeviceFacts& facts, ebac::Timing timing) {
      const double late = (timing.delay + 0.5) * timing.dt + facts.current_lag;
      return {.virtual_damping = 0.35 * facts.mass / late, .peak_force = facts.peak_force};
    }
    /// Names, units and ranges: Python's keywords, errors and documentation come from here.
    static constexpr auto fields() {
      using F = ebac::Field<Params>;
      return std::array{
          F{"virtual_damping", &Params::virtual_damping, "N s/m", "damping in contact", 0, 500},
          F{"peak_force", &Params::peak_force, "N", "largest command", 1e-3, 1e4},
      };
    }
  };

  /// What a trace records of it.
  struct State {
    double injected = 0;  // N

    static constexpr auto fields() {
      return std::array{
          ebac::Field<State>{"injected", &State::injected, "N", "force of the virtual damper"}};
    }
  };

  explicit Damped(const Params& params, const ebac::Timing& timing = {})
      : params_(ebac::checked(params, "Damped")), timing_(ebac::checked(timing, "Timing")) {}

  double step(const ebac::Port& port) EBAC_RT {
    state_.injected = port.f_env > 0 ? params_.virtual_damping * port.v : 0.0;
    return std::clamp(port.f_env + state_.injected, -params_.peak_force, params_.peak_force);
  }
  void reset() EBAC_RT { state_ = {}; }
  /// Optional: takes the gains of `next` while it runs and keeps its state.
  void retune(const Damped& next) EBAC_RT { params_ = next.params_; }
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const ebac::Timing& timing() const EBAC_RT { return timing_; }

 private:
  Params params_;
  ebac::Timing timing_;
  State state_{};
};

static_assert(ebac::Controller<Damped>);
