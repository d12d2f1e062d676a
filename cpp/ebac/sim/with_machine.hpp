#pragma once

#include <array>
#include <memory>
#include <utility>

#include "ebac/core/device.hpp"
#include "ebac/loop/row_parts.hpp"

namespace ebac {

/// A machine that the axes of a simulated device move, in place of a hand.
class DrivenMachine {
 public:
  virtual ~DrivenMachine() = default;

  /// The axes stand at `x` [m], and `elapsed` [s] have passed. Returns what resists each of them [N]. From one thread.
  virtual std::array<double, kMaxAxes> meet(const std::array<double, kMaxAxes>& x,
                                            double elapsed) EBAC_RT = 0;

 protected:
  DrivenMachine() = default;
  DrivenMachine(const DrivenMachine&) = default;
  DrivenMachine& operator=(const DrivenMachine&) = default;
};

/// A simulated device with a machine behind it, if there is one. The machine is elastic: its force goes on along a spring of
/// the hand's stiffness from one tick to the next, so that a stiff one does not shake. Copies share it.
template <class D>
class WithMachine {
 public:
  /// `stiffness` of the hand [N/m], above 0 where there is a machine.
  explicit WithMachine(D device, std::shared_ptr<DrivenMachine> machine = nullptr,
                       double stiffness = 1)
      : device_(std::move(device)), machine_(std::move(machine)), stiffness_(stiffness) {}

  Reading exchange(const Command& command) EBAC_RT {
    // A reading without elapsed time moves nothing.
    if (machine_ == nullptr || !(command.elapsed > 0)) return device_.exchange(command);
    const Reading reading = device_.exchange(command);
    std::array<double, kMaxAxes> x{};
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = device_.state(i).x;
    const std::array<double, kMaxAxes> push = machine_->meet(x, command.elapsed);
    for (std::size_t i = 0; i < x.size(); ++i) device_.aim(i, x[i] - push[i] / stiffness_);
    return reading;
  }

  void aim(std::size_t axis, double target) EBAC_RT {
    if (machine_ == nullptr) device_.aim(axis, target);
  }
  const auto& state(std::size_t axis) const EBAC_RT { return device_.state(axis); }
  auto parts() const EBAC_RT { return row_parts(device_); }

 private:
  D device_;
  std::shared_ptr<DrivenMachine> machine_;
  double stiffness_;  // N/m
};

}  // namespace ebac
