#pragma once

#include <limits>
#include <span>
#include <utility>

#include "ebac/control/ebac.hpp"
#include "ebac/faults/trouble.hpp"
#include "ebac/loop/mail.hpp"
#include "ebac/sim/simulated_device.hpp"

namespace ebac::faults {

inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// The simulated plant, with an encoder that may jump.
class FaultyPlant {
 public:
  FaultyPlant(SimulatedDevice plant, const Trouble& trouble)
      : plant_(std::move(plant)), trouble_(&trouble) {}

  Reading exchange(const Command& command) EBAC_RT {
    Reading reading = plant_.exchange(command);
    if (trouble_->on(Kind::kEncoderJump)) {
      const auto size = static_cast<std::int64_t>(200 + trouble_->chance % 100'000);
      reading.counts[trouble_->axis] += (trouble_->chance & 1U) != 0 ? size : -size;
    }
    return reading;
  }
  const SimulatedDevice& simulated() const EBAC_RT { return plant_; }

 private:
  SimulatedDevice plant_;
  const Trouble* trouble_;
};

/// EBAC on every axis; it may lose its mind.
class FaultyLaw {
 public:
  using State = Ebac::State;
  using Scalar = Ebac;

  FaultyLaw(const Ebac& law, const Trouble& trouble) : law_(law), trouble_(&trouble) {}

  void step(std::span<Axis> axes, const Touch& touch) EBAC_RT {
    law_.step(axes, touch);
    if (trouble_->on(Kind::kNanLaw)) axes[trouble_->axis].port.f_cmd = kNoNumber;
  }
  void reset() EBAC_RT { law_.reset(); }
  void retune(const Ebac& next) EBAC_RT { law_.retune(next); }
  const State& state(std::size_t i) const EBAC_RT { return law_.state(i); }

 private:
  PerAxis<Ebac> law_;
  const Trouble* trouble_;
};

/// Virtual time that counts the ticks of the case, may be late, and brings the mail.
class FaultyClock {
 public:
  FaultyClock(double dt, Trouble& trouble, const Ebac& law, Mail<FaultyLaw>& mail)
      : dt_(dt), trouble_(&trouble), law_(law), mail_(&mail), random_(trouble.chance) {}

  Instant wait() EBAC_RT {
    ++trouble_->tick;
    write();
    if (trouble_->tick == 0) return {};
    const bool late = trouble_->on(Kind::kOverruns);
    const std::int64_t skipped = late ? 1 + static_cast<std::int64_t>(random_.bits() % 2) : 0;
    const double dt = dt_ * static_cast<double>(1 + skipped);
    t_ += dt;
    return {.t = t_, .dt = dt, .lateness = 0, .skipped = skipped};
  }

 private:
  void write() EBAC_RT {
    if (trouble_->begins(Kind::kStop)) mail_->stop();
    if (trouble_->begins(Kind::kNanWorld)) mail_->post(Environment(Wall{.position = kNoNumber}));
    if (!trouble_->on(Kind::kParameterWrites)) return;
    const double some = 0.5 + 0.5 * random_.symmetric();
    if (random_.bits() % 4 == 0) {
      mail_->post(Environment(Wall{.stiffness = 20e3 * some, .position = 0.01 * some}));
    }
    if (random_.bits() % 4 == 0) {
      Ebac::Params params = law_.params();
      params.kp *= some;
      params.peak_force *= 0.1 + 0.9 * some;
      mail_->post(Ebac(params, law_.timing()));
    }
  }

  double dt_;  // s
  Trouble* trouble_;
  Ebac law_;
  Mail<FaultyLaw>* mail_;
  Noise random_;
  double t_ = 0;  // s
};

}  // namespace ebac::faults
