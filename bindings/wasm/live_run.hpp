#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ebac/control/beta.hpp"
#include "ebac/control/law_types.hpp"
#include "ebac/control/per_axis.hpp"
#include "ebac/loop/tick.hpp"
#include "ebac/loop/virtual_clock.hpp"
#include "ebac/sim/contact.hpp"
#include "ebac/sim/simulated_device.hpp"

namespace ebac::wasm {

/// One row of what a page shows.
struct Shown {
  double t = 0;          // s
  double x = 0;          // m
  double v = 0;          // m/s
  double target = 0;     // m
  double f_env = 0;      // N
  double f_cmd = 0;      // N
  double f_applied = 0;  // N
  double energy = 0;     // J
  double beta = 0;       // N/m

  static constexpr auto fields() {
    using F = Field<Shown>;
    return std::array{
        F{"t", &Shown::t, "s", "time since the start"},
        F{"x", &Shown::x, "m", "true handle position; grows into the wall"},
        F{"v", &Shown::v, "m/s", "true handle velocity"},
        F{"target", &Shown::target, "m", "where the hand wants to be"},
        F{"f_env", &Shown::f_env, "N", "force the virtual wall asks for"},
        F{"f_cmd", &Shown::f_cmd, "N", "force the law commands"},
        F{"f_applied", &Shown::f_applied, "N", "force that acted over the last interval"},
        F{"energy", &Shown::energy, "J", "physical port energy; negative: the wall gave it out"},
        F{"beta", &Shown::beta, "N/m", "slope dF/dx the law took; NaN for a law without one"},
    };
  }
};

/// The law of that name as `simulate` designs it: from device and timing alone.
inline AnyLaw designed(const LawType& type, const Setup& setup) {
  Timing known = setup.timing;
  known.jitter = std::max(known.jitter, setup.jitter);
  std::vector<std::byte> params(type.params.size);
  type.design(params.data(), setup.device.facts(), known);
  return type.make(params.data(), known);
}

/// A simulated run that is stepped as a page needs it, where `simulate` runs to the end. The same
/// tick, the same bits.
class LiveRun {
 public:
  LiveRun(const Setup& setup, const LawType& type)
      : LiveRun(setup, PerAxis<AnyLaw>(designed(type, setup))) {
    beta_ = type.state.find("beta");
  }

  /// From now on the hand wants to be at `target` [m].
  void aim(double target) {
    device_.aim(0, target);
    target_ = target;
  }
  /// From now on another wall.
  void change(const Wall& wall) {
    check(wall, "Wall");
    wall_ = wall;
    chain_.change(wall);
  }

  Shown step() {
    tick(chain_, law_, device_, clock_.wait(), sample_);
    ++sample_.tick;
    const Port& port = sample_.axis[0].port;
    const AxisTruth& truth = device_.state(0);
    return {.t = sample_.t,
            .x = truth.x,
            .v = truth.v,
            .target = target_at(sample_.t),
            .f_env = port.f_env,
            .f_cmd = port.f_cmd,
            .f_applied = port.f_applied,
            .energy = truth.energy,
            .beta = beta_ == nullptr ? kUndefined : beta_->number(law_.state(0))};
  }

  Fault fault() const { return sample_.fault; }
  const Wall& wall() const { return wall_; }

 private:
  LiveRun(const Setup& setup, PerAxis<AnyLaw> law)
      : device_(setup),
        chain_(setup.device, setup.environment, law.timing(), observing(setup.observer, law)),
        law_(std::move(law)),
        clock_(setup.timing.dt, setup.jitter, setup.seed),
        wall_(std::get<Wall>(setup.environment)),
        path_(std::get<Step>(setup.hand.path[0])) {
    sample_.axes = setup.device.axes();
  }

  double target_at(double t) const { return aimed() ? target_ : path_.position(t); }
  bool aimed() const { return target_ == target_; }

  SimulatedDevice device_;
  SignalChain chain_;
  PerAxis<AnyLaw> law_;
  VirtualClock clock_;
  Wall wall_;
  Step path_;
  Sample sample_{};
  const FieldRow* beta_ = nullptr;
  double target_ = kUndefined;  // m, once it was aimed
};

}  // namespace ebac::wasm
