#pragma once

#include <array>
#include <memory>
#include <utility>

#include "ebac/core/concepts.hpp"
#include "ebac/loop/mailbox.hpp"
#include "ebac/loop/row_parts.hpp"

namespace ebac::sensor {

/// The force at a handle, in the handle's axes [N]: from who moves it to who measures it, in another
/// thread.
using ForceCell = Mailbox<std::array<double, kMaxAxes>>;

/// A device whose force is also told to a cell, where there is one. Copies share the cell.
template <Device D>
class Felt {
 public:
  explicit Felt(D device, std::shared_ptr<ForceCell> cell = nullptr)
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
  std::shared_ptr<ForceCell> cell_;
};

}  // namespace ebac::sensor
