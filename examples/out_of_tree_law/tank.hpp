#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <ebac/core/controller.hpp>
#include <string_view>
#include <utility>

/// The shortest law that we know to compare with `ebac`: on the same state observer the world's force, softer for small
/// fast changes, a virtual damper, an energy tank and a limit on what the command can give out.
class Tank {
 public:
  static constexpr std::string_view kName = "tank";
  static constexpr std::string_view kSummary = "damper, softening, tank and guard on the observer";
  static constexpr bool kPassive = false;

  struct Params {
    double virtual_damping = 60;  // N s/m
    double softening = 0.85;      // 1
    double small = 3.7;           // N
    double memory = 0.09;         // s
    double reserve = 1e-3;        // J
    double pull = 3;              // N
    double mass = 0.25;           // kg
    double device_damping = 2;    // N s/m
    double count = 3.07e-5;       // m
    double current_lag = 3e-4;    // s
    double peak_force = 42.4;     // N

    static Params design(const ebac::DeviceFacts& facts, ebac::Timing timing) {
      const double late = (timing.delay + 0.8) * timing.dt + facts.current_lag;
      return {.virtual_damping = 0.55 * facts.mass / late,
              .mass = facts.mass,
              .device_damping = facts.damping,
              .count = facts.count,
              .current_lag = facts.current_lag,
              .peak_force = facts.peak_force};
    }
    static constexpr auto fields() {
      using F = ebac::Field<Params>;
      return std::array{
          F{"virtual_damping", &Params::virtual_damping, "N s/m", "damping in contact", 0, 500},
          F{"softening", &Params::softening, "1", "share by which small fast changes are softer", 0,
            0.99},
          F{"small", &Params::small, "N", "size of a small change", 1e-6, 1e3},
          F{"memory", &Params::memory, "s", "time constant of the softening", 1e-4, 10},
          F{"reserve", &Params::reserve, "J", "energy in the tank at the start", 0, 1},
          F{"pull", &Params::pull, "N", "pull of the hand beyond what the sensor shows", 0, 1e3},
          F{"mass", &Params::mass, "kg", "mass of the device", 1e-3, 100},
          F{"device_damping", &Params::device_damping, "N s/m", "damping of the device", 0, 500},
          F{"count", &Params::count, "m", "count of the encoder", 0, 0.01},
          F{"current_lag", &Params::current_lag, "s", "lag of the current loop", 0, 0.1},
          F{"peak_force", &Params::peak_force, "N", "largest command", 1e-3, 1e4},
      };
    }
  };

  struct State {
    double energy = 0;  // J
    static constexpr auto fields() {
      return std::array{ebac::Field<State>{"energy", &State::energy, "J", "energy in the tank"}};
    }
  };

  explicit Tank(const Params& params, const ebac::Timing& timing = {})
      : p_(ebac::checked(params, "Tank")), timing_(ebac::checked(timing, "Timing")) {
    reset();
  }

  bool observed() const { return true; }

  double step(const ebac::Port& port) EBAC_RT {
    if (!(port.dt > 0)) return 0;
    fill(port);
    const double force = port.f_env > 0 ? affordable(wanted(port), port) : out_of_contact();
    before_ = std::exchange(last_, std::clamp(force, -p_.peak_force, p_.peak_force));
    return last_;
  }
  void reset() EBAC_RT {
    state_.energy = p_.reserve;
    last_ = before_ = slow_ = slower_ = acts_ = within_ = mean_ = 0;
  }
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return p_; }
  const ebac::Timing& timing() const EBAC_RT { return timing_; }

 private:
  /// What the force has taken in over the last interval: at the estimated position, within half a count of the reading;
  /// less half a count for what jumps.
  void fill(const ebac::Port& port) EBAC_RT {
    const double lag = p_.current_lag, half = p_.count / 2;
    const double left = lag > 0 ? std::exp(-port.dt / lag) : 0.0;
    const double mean = port.f_applied + (acts_ - port.f_applied) * (1 - left) * lag / port.dt;
    acts_ = port.f_applied + (acts_ - port.f_applied) * left;
    const double within = std::clamp(port.est.x - port.x, -half, half);
    const double jumped = std::max(0.0, std::abs(std::exchange(mean_, mean) - mean) - 0.05);
    state_.energy += mean * (port.dx + within - within_) +
                     p_.device_damping * port.est.v * port.est.v * port.dt - half * jumped;
    within_ = within;
  }

  /// The world's force, of which small fast changes are softer, and the damper.
  double wanted(const ebac::Port& port) EBAC_RT {
    const double change = port.f_env - slower_;
    const double fast = 3 * change / p_.small;
    const double time = p_.memory / std::min(1 + fast * fast, 20.0), root = std::sqrt(p_.softening);
    slow_ += (port.f_env - slow_) * port.dt / (time / (1 - root) + port.dt);
    slower_ += (slow_ - slower_) * port.dt / (time / (1 + root) + port.dt);
    const double size = 1 + change * change / (p_.small * p_.small);
    const double softer = p_.softening * change / (size * size);
    return std::max(0.0, port.f_env - softer + p_.virtual_damping * port.est.v_act);
  }

  /// The largest force up to `wanted` that gives out no more than the tank holds until the next command acts, when the
  /// hand pulls: F (out + (n + 1/2) dt^2/M (pull + F)) is a quadratic in F.
  double affordable(double wanted, const ebac::Port& port) const EBAC_RT {
    const double gain = port.dt * port.dt / p_.mass, out = std::max(0.0, -port.est.v) * port.dt;
    const double pull = p_.pull + std::max(0.0, -port.f_meas);
    const double top =
        std::max({acts_, timing_.delay > 0 ? last_ : 0.0, timing_.delay > 1 ? before_ : 0.0});
    double left = state_.energy;
    for (int n = 0; n < timing_.delay; ++n) {
      const double flying = n + 1 < timing_.delay ? before_ : last_;
      left -= flying * (out + (n + 0.5) * gain * (pull + top));
    }
    const double lag = p_.current_lag / port.dt;
    left -= lag * top * (out + 0.5 * gain * (pull + top));
    const double square = (1 + lag) * (timing_.delay + 0.5) * gain;
    const double linear = (1 + lag) * out + square * pull;
    const double most =
        (-linear + std::sqrt(linear * linear + 4 * square * std::max(left, 0.0))) / (2 * square);
    return std::min(wanted, most);
  }

  double out_of_contact() EBAC_RT { return slow_ = slower_ = 0; }

  Params p_;
  ebac::Timing timing_;
  State state_{};
  double last_ = 0, before_ = 0;  // N, the last commands
  double slow_ = 0, slower_ = 0;  // N, the world's force behind two lags
  double acts_ = 0, mean_ = 0;    // N, of the motor: now, and over the last interval
  double within_ = 0;             // m, of the estimate from the reading
};

static_assert(ebac::Controller<Tank>);
