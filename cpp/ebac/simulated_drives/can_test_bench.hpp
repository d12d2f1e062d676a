#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "ebac/canopen/canopen_device.hpp"
#include "ebac/canopen/torque.hpp"
#include "ebac/simulated_drives/joystick_on_bus.hpp"
#include "ebac/simulated_drives/timed_bus.hpp"
#include "ebac/simulated_drives/watched_drives.hpp"

namespace ebac::can {

/// Test bench: a plant with simulated drives, a bus, and the loop's side of it, in one thread and
/// in virtual time. Not movable: its parts refer to each other.
template <Device D>
class CanTestBench {
 public:
  using Can = CanopenDevice<VirtualBus, OnOtherSide<JoystickOnBus<D>>>;

  /// `plant` takes its currents without delay, as a drive sets them at the SYNC. The drives are set
  /// up and operational, and at rest. `dt` is the sample time [s]; with `timed` the bus takes its
  /// time, and drives and loop watch each other.
  explicit CanTestBench(D plant, const DeviceModel& device, double dt = 1e-3,
                        const std::optional<TimedBus>& timed = {})
      : timed_(timed.value_or(TimedBus{})),
        bus_(timed ? VirtualBus(SimulatedWire(wire_of(*timed, device.axes()))) : VirtualBus()),
        other_(std::move(plant), device, bus_,
               {.dt = dt, .answer = timed_.answer_share * dt, .response = timed_.response}),
        can_(bus_, OnOtherSide(other_), can_setup(device, timed)) {
    const auto most = static_cast<int>(
        std::min(TorqueScale::of(device.motor, device.drive).most, timed_.peak_ratio * 1000 + 0.5));
    const Watches watches = timed ? watches_of(*timed) : Watches{};
    for (std::size_t i = 0; i < joystick().axes(); ++i) set_up(joystick().drive(i), most, watches);
    bus_.send(frame(kNmt, {kStartNode, kAllNodes}));
    if (!timed) return;
    // Until the loop has heard that every drive is operational.
    const int beats = static_cast<int>(2 * timed_.drive_heartbeat / dt) + 1;
    for (int i = 0; i < beats; ++i) static_cast<void>(can_.exchange({}));
  }
  CanTestBench(const CanTestBench&) = delete;
  CanTestBench& operator=(const CanTestBench&) = delete;
  CanTestBench(CanTestBench&&) = delete;
  CanTestBench& operator=(CanTestBench&&) = delete;
  ~CanTestBench() = default;

  /// An exchange of the loop, with the reading of the force sensor, which is not on this bus.
  Reading exchange(const Command& command) EBAC_RT {
    t_ += command.elapsed;
    SimulatedWire* wire = bus_.wire();
    if (wire != nullptr && timed_.broken > 0 && t_ >= timed_.broken_from) {
      wire->set_error_rate(station_of(timed_.broken), 1);
    }
    Reading reading = can_.exchange(command);
    const Reading& plant = other_.joystick().reading();
    reading.force = plant.force;
    reading.force_age = plant.force_age;
    reading.force_status = plant.force_status;
    return reading;
  }

  /// Whether no drive has power.
  bool off() const EBAC_RT { return joystick().off(); }

  Can& can() EBAC_RT { return can_; }
  const Can& can() const EBAC_RT { return can_; }
  const VirtualBus& bus() const EBAC_RT { return bus_; }
  Joystick<Still<D>>& joystick() EBAC_RT { return other_.joystick(); }
  const Joystick<Still<D>>& joystick() const EBAC_RT { return other_.joystick(); }
  const D& plant() const EBAC_RT { return other_.plant(); }

 private:
  static constexpr auto kStartNode = static_cast<std::uint8_t>(NmtCommand::kStart);
  static constexpr std::uint8_t kAllNodes = 0;

  static std::size_t station_of(int node) EBAC_RT {
    return VirtualBus::kFirstDrive + static_cast<std::size_t>(node - 1);
  }

  TimedBus timed_;
  VirtualBus bus_;
  JoystickOnBus<D> other_;
  Can can_;
  double t_ = 0;  // s
};

}  // namespace ebac::can
