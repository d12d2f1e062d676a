#pragma once

#include <array>
#include <memory>
#include <utility>

#include "ebac/core/concepts.hpp"
#include "ebac/loop/mailbox.hpp"
#include "ebac/loop/row_parts.hpp"

namespace ebac::sensor {

/// The force at a handle, in the axes of the handle [N]: from the simulation of the hand to an
/// emulated sensor, in another thread.
using SharedForce = Mailbox<std::array<double, kMaxAxes>>;

/// A device that also publishes its force to a shared force, if there is one. Copies share it.
template <Device D>
class ForcePublisher {
 public:
  explicit ForcePublisher(D device, std::shared_ptr<SharedForce> cell = nullptr)
      : device_(std::move(device)), cell_(std::move(cell)) {}

  Reading exchange(const Command& command) EBAC_RT {
    const Reading reading = device_.exchange(command);
    if (cell_ != nullptr) cell_->post(reading.force);
    return reading;
  }

  void aim(std::size_t axis, double target) EBAC_RT
    requires requires(D& d) { d.aim(axis, target); }
  {
    device_.aim(axis, target);
  }

  auto parts() const EBAC_RT { return row_parts(device_); }
  const D& device() const EBAC_RT { return device_; }

 private:
  D device_;
  std::shared_ptr<SharedForce> cell_;
};

}  // namespace ebac::sensor
