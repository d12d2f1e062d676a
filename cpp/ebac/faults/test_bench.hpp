#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "ebac/can/can_desk.hpp"
#include "ebac/faults/faulty_bus.hpp"
#include "ebac/faults/faulty_parts.hpp"

namespace ebac::faults {

/// A plant, its drives and a bus on which things go wrong, in virtual time; the drives watch the
/// loop as the loop watches them. It stays where it is: its parts know each other.
class Desk {
 public:
  using Other = can::JoystickOnBus<FaultyPlant>;
  using Can = can::CanopenDevice<FaultyBus, can::RunOther<Other>>;
  static constexpr int kOwnNode = 100;

  Desk(const Setup& setup, Trouble& trouble);
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;
  Desk(Desk&&) = delete;
  Desk& operator=(Desk&&) = delete;
  ~Desk() = default;

  /// What the drives do wrong themselves begins and ends here.
  Reading exchange(const Command& command) EBAC_RT;

  Can& can() EBAC_RT { return can_; }
  can::SimulatedDrive& drive(std::size_t axis) EBAC_RT { return other_.joystick().drive(axis); }
  std::size_t axes() EBAC_RT { return other_.joystick().axes(); }
  const SimulatedDevice& plant() const EBAC_RT { return other_.plant().simulated(); }
  /// No motor has current, and none may get any.
  bool off() EBAC_RT;

 private:
  void set_up(can::SimulatedDrive& drive, int most) const;
  void spoil_drive() EBAC_RT;
  void spoil_sensor(Reading& reading) EBAC_RT;

  Trouble* trouble_;
  can::LoopbackHub hub_;
  Other other_;
  FaultyBus near_;
  Can can_;
  double force_age_ = 0;  // s
};

/// The desk as the loop's device.
class FaultyDevice {
 public:
  explicit FaultyDevice(Desk& desk) EBAC_RT : desk_(&desk) {}

  Reading exchange(const Command& command) EBAC_RT { return desk_->exchange(command); }
  void enable() EBAC_RT { desk_->can().enable(); }
  void disable() EBAC_RT { desk_->can().disable(); }
  void stop() EBAC_RT { desk_->can().stop(); }
  bool running() const EBAC_RT { return desk_->can().running(); }
  auto parts() const EBAC_RT { return std::tie(desk_->plant(), std::as_const(desk_->can())); }

 private:
  Desk* desk_;
};

static_assert(Device<FaultyDevice>);

}  // namespace ebac::faults
