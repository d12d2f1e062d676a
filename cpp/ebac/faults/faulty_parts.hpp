#pragma once

#include <limits>
#include <span>
#include <utility>

#include "ebac/control/ebac.hpp"
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

/// EBAC on every axis; it may lose its mind.
class FaultyLaw {
 public:
  using State = Ebac::State;
  using Scalar = Ebac;

  FaultyLaw(const Ebac& law, const InjectedFault& injected) : law_(law), injected_(&injected) {}

  void step(std::span<Axis> axes, const ContactForce& contact) EBAC_RT {
    law_.step(axes, contact);
    if (injected_->on(Kind::kNanLaw)) axes[injected_->axis].port.f_cmd = kNoNumber;
  }
  void reset() EBAC_RT { law_.reset(); }
  void retune(const Ebac& next) EBAC_RT { law_.retune(next); }
  const State& state(std::size_t i) const EBAC_RT { return law_.state(i); }

 private:
  PerAxis<Ebac> law_;
  const InjectedFault* injected_;
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
    const bool late = injected_->on(Kind::kOverruns);
    const std::int64_t skipped = late ? 1 + static_cast<std::int64_t>(random_.bits() % 2) : 0;
    const double dt = dt_ * static_cast<double>(1 + skipped);
    t_ += dt;
    return {.t = t_, .dt = dt, .lateness = 0, .skipped = skipped};
  }

 private:
  void write() EBAC_RT {
    if (injected_->begins(Kind::kStop)) updates_->stop();
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

  double dt_;  // s
  InjectedFault* injected_;
  Ebac law_;
  ParameterUpdates<FaultyLaw>* updates_;
  Noise random_;
  double t_ = 0;  // s
};

}  // namespace ebac::faults
