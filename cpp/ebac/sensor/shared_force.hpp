#pragma once

#include <array>
#include <memory>
#include <utility>

#include "ebac/loop/device_around.hpp"
#include "ebac/loop/mailbox.hpp"

namespace ebac::sensor {

/// The force at a handle, in the axes of the handle [N]: from the simulation of the hand to an
/// emulated sensor, in another thread.
using SharedForce = Mailbox<std::array<double, kMaxAxes>>;

/// A device that also publishes its force to a shared force, if there is one. Copies share it.
template <Device D>
class ForcePublisher : public DeviceAround<D> {
  using DeviceAround<D>::device_;

 public:
  explicit ForcePublisher(D device, std::shared_ptr<SharedForce> cell = nullptr)
      : DeviceAround<D>(std::move(device)), cell_(std::move(cell)) {}

  Reading exchange(const Command& command) EBAC_RT {
    const Reading reading = device_.exchange(command);
    if (cell_ != nullptr) cell_->post(reading.force);
    return reading;
  }

 private:
  std::shared_ptr<SharedForce> cell_;
};

}  // namespace ebac::sensor
