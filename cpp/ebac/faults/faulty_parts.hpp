#pragma once

#include <limits>
#include <span>
#include <utility>

#include "ebac/control/ebac.hpp"
#include "ebac/control/per_axis.hpp"
#include "ebac/faults/injected_fault.hpp"
#include "ebac/loop/parameter_updates.hpp"
#include "ebac/sim/simulated_device.hpp"

namespace ebac::faults {

inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// The simulated plant, with an encoder that may jump or freeze, and a motor that may be reversed.
class FaultyPlant {
 public:
  FaultyPlant(SimulatedDevice plant, const InjectedFault& injected)
      : plant_(std::move(plant)), injected_(&injected) {}

  Reading exchange(Command command) EBAC_RT {
    double& current = command.current[injected_->axis];
    if (injected_->on(Kind::kTorqueReversed)) current = -current;
    Reading reading = plant_.exchange(command);
    std::int64_t& counts = reading.counts[injected_->axis];
    if (injected_->on(Kind::kEncoderFrozen)) counts = counts_;
    counts_ = counts;
    if (injected_->on(Kind::kEncoderJump)) {
      const auto size = static_cast<std::int64_t>(200 + injected_->chance % 100'000);
      counts += (injected_->chance & 1U) != 0 ? size : -size;
    }
    return reading;
  }
  const SimulatedDevice& simulated() const EBAC_RT { return plant_; }

 private:
  SimulatedDevice plant_;
  const InjectedFault* injected_;
  std::int64_t counts_ = 0;  // as last shown
};

/// What a law without measure asks for [N]: half as much again as the device has, one way, or to and fro.
inline double all_force(const InjectedFault& injected, double peak) EBAC_RT {
  const double size = injected.asks_against() ? 1.5 * peak : -1.5 * peak;
  const bool swings = injected.kind == Kind::kForceSwings || injected.kind == Kind::kNanJoint;
  const auto half = static_cast<std::int64_t>(3 + (injected.chance >> 21U) % 18);  // ticks
  return swings && (injected.tick - injected.at) / half % 2 != 0 ? -size : size;
}

/// EBAC on every axis; it may lose its mind.
class FaultyLaw {
 public:
  using State = Ebac::State;
  using Scalar = Ebac;

  FaultyLaw(const Ebac& law, InjectedFault& injected)
      : law_(law), peak_(law.params().peak_force), injected_(&injected) {}

  void step(std::span<Axis> axes, const ContactForce& contact) EBAC_RT {
    law_.step(axes, contact);
    injected_->last_asked = injected_->tick;
    Axis& axis = axes[injected_->axis];
    if (injected_->asks_now()) axis.port.f_cmd = all_force(*injected_, peak_);
    if (injected_->on(Kind::kNanJoint)) axis.joint.dq = kNoNumber;
    if (injected_->on(Kind::kNanLaw)) axes[injected_->axis].port.f_cmd = kNoNumber;
  }
  void reset() EBAC_RT { law_.reset(); }
  void retune(const Ebac& next) EBAC_RT { law_.retune(next); }
  const State& state(std::size_t i) const EBAC_RT { return law_.state(i); }

 private:
  PerAxis<Ebac> law_;
  double peak_;  // N
  InjectedFault* injected_;
};

/// Virtual clock that counts the ticks of the case, may be late, and posts the parameter updates.
class FaultyClock {
 public:
  FaultyClock(double dt, InjectedFault& injected, const Ebac& law,
              ParameterUpdates<FaultyLaw>& updates)
      : dt_(dt), injected_(&injected), law_(law), updates_(&updates), random_(injected.chance) {}

  Instant wait() EBAC_RT {
    ++injected_->tick;
    write();
    if (injected_->tick == 0) return {};
    const std::int64_t skipped = late();
    const double dt = dt_ * static_cast<double>(1 + skipped);
    t_ += dt;
    return {.t = t_, .dt = dt, .lateness = 0, .skipped = skipped};
  }

 private:
  /// Ticks that could not be kept.
  std::int64_t late() EBAC_RT {
    constexpr std::uint64_t kShortest = 10, kLongest = 40;  // of a pause, ticks
    const auto some = [&](std::uint64_t low, std::uint64_t high) {
      return static_cast<std::int64_t>(low + random_.bits() % (high - low + 1));
    };
    if (injected_->on(Kind::kPause)) return some(kShortest, kLongest);
    return injected_->on(Kind::kOverruns) ? some(1, 2) : 0;
  }

  void write() EBAC_RT {
    if (injected_->tick > kMostTicks) {
      injected_->endless = true;
      updates_->stop(/*at_once=*/true);
    }
    if (injected_->begins(Kind::kStop)) updates_->stop(injected_->at_once());
    if (injected_->begins(Kind::kNanWorld))
      updates_->post(Environment(Wall{.position = kNoNumber}));
    if (!injected_->on(Kind::kParameterWrites)) return;
    const double some = 0.5 + 0.5 * random_.symmetric();
    if (random_.bits() % 4 == 0) {
      updates_->post(Environment(Wall{.stiffness = 20e3 * some, .position = 0.01 * some}));
    }
    if (random_.bits() % 4 == 0) {
      Ebac::Params params = law_.params();
      params.kp *= some;
      params.peak_force *= 0.1 + 0.9 * some;
      updates_->post(Ebac(params, law_.timing()));
    }
  }

  static constexpr std::int64_t kMostTicks = 900;  // more than any plan

  double dt_;  // s
  InjectedFault* injected_;
  Ebac law_;
  ParameterUpdates<FaultyLaw>* updates_;
  Noise random_;
  double t_ = 0;  // s
};

}  // namespace ebac::faults
