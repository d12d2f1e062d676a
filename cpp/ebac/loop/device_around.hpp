#pragma once

#include <cstddef>
#include <utility>

#include "ebac/core/device.hpp"
#include "ebac/loop/row_parts.hpp"

namespace ebac {

/// Base of a device around another one, which adds an `exchange`: passes all other calls on, as far as the device within
/// has them.
template <Device D>
class DeviceAround {
 public:
  void enable() EBAC_RT
    requires requires(D& d) { d.enable(); }
  {
    static_assert(noexcept(device_.enable()));
    device_.enable();
  }
  void disable() EBAC_RT
    requires requires(D& d) { d.disable(); }
  {
    static_assert(noexcept(device_.disable()));
    device_.disable();
  }
  void stop() EBAC_RT
    requires requires(D& d) { d.stop(); }
  {
    device_.stop();
  }
  bool running() const EBAC_RT
    requires requires(const D& d) { d.running(); }
  {
    return device_.running();
  }
  bool at_rest() const EBAC_RT
    requires requires(const D& d) { d.at_rest(); }
  {
    return device_.at_rest();
  }
  void aim(std::size_t axis, double target) EBAC_RT
    requires requires(D& d) { d.aim(axis, target); }
  {
    device_.aim(axis, target);
  }

  auto parts() const EBAC_RT { return row_parts(device_); }
  D& device() EBAC_RT { return device_; }
  const D& device() const EBAC_RT { return device_; }

 protected:
  explicit DeviceAround(D device) : device_(std::move(device)) {}

  D device_;
};

}  // namespace ebac
