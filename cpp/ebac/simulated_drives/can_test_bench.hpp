#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "ebac/can/loopback_bus.hpp"
#include "ebac/canopen/canopen_device.hpp"
#include "ebac/canopen/torque.hpp"
#include "ebac/model/device.hpp"
#include "ebac/simulated_drives/joystick.hpp"

namespace ebac::can {

/// A plant whose reading stays the same as long as no time passes, however often it is read: a SYNC
/// before the start then draws no noise.
template <Device D>
class Still {
 public:
  explicit Still(D plant) : plant_(std::move(plant)) {}

  Reading exchange(const Command& command) EBAC_RT {
    if (!read_ || command.elapsed > 0) reading_ = plant_.exchange(command);
    read_ = true;
    return reading_;
  }
  const D& plant() const EBAC_RT { return plant_; }

 private:
  D plant_;
  Reading reading_{};
  bool read_ = false;
};

/// A plant with simulated drives on one end of a bus.
template <Device D>
class JoystickOnBus {
 public:
  JoystickOnBus(D plant, const DeviceModel& device, LoopbackBus end)
      : joystick_(Still<D>(std::move(plant)), device, /*first=*/1, kPeakTime),
        end_(std::move(end)) {}

  /// Advances time, receives the waiting frames and sends the answers.
  void run(double elapsed) EBAC_RT {
    joystick_.elapse(elapsed);
    Frame frame;
    while (end_.receive(frame)) joystick_.receive(frame);
    while (joystick_.take(frame)) end_.send(frame);
  }

  const D& plant() const EBAC_RT { return joystick_.plant().plant(); }
  Joystick<Still<D>>& joystick() EBAC_RT { return joystick_; }
  const Joystick<Still<D>>& joystick() const EBAC_RT { return joystick_; }

 private:
  static constexpr double kPeakTime = 65.535;  // s, the longest: a motor that hardly warms

  Joystick<Still<D>> joystick_;
  LoopbackBus end_;
};

/// Test bench: a plant with simulated drives, a bus, and the loop's side of it, in one thread and
/// in virtual time. Not movable: its parts refer to each other.
template <Device D>
class CanTestBench {
 public:
  using Can = CanopenDevice<LoopbackBus, RunOther<JoystickOnBus<D>>>;

  /// `plant` takes its currents without delay, as a drive sets them at the SYNC. The drives are set
  /// up and operational, and at rest.
  CanTestBench(D plant, const DeviceModel& device)
      : other_(std::move(plant), device, hub_.open()),
        can_(near_, RunOther(other_),
             {.axes = device.axes(), .motor = device.motor, .drive = device.drive}) {
    const auto most = static_cast<int>(TorqueScale::of(device.motor, device.drive).most);
    for (std::size_t i = 0; i < joystick().axes(); ++i) set_up(joystick().drive(i), most);
    near_.send(frame(kNmt, {kStartNode, kAllNodes}));
  }
  CanTestBench(const CanTestBench&) = delete;
  CanTestBench& operator=(const CanTestBench&) = delete;
  CanTestBench(CanTestBench&&) = delete;
  CanTestBench& operator=(CanTestBench&&) = delete;
  ~CanTestBench() = default;

  Can& can() EBAC_RT { return can_; }
  const Can& can() const EBAC_RT { return can_; }
  Joystick<Still<D>>& joystick() EBAC_RT { return other_.joystick(); }
  const D& plant() const EBAC_RT { return other_.plant(); }
  /// Adds the reading of the force sensor, which is not on this bus.
  void add_sensor(Reading& reading) const EBAC_RT {
    const Reading& plant = other_.joystick().reading();
    reading.force = plant.force;
    reading.force_age = plant.force_age;
    reading.force_status = plant.force_status;
  }

 private:
  static constexpr std::uint8_t kStartNode = 0x01;
  static constexpr std::uint8_t kAllNodes = 0;

  static void set_up(SimulatedDrive& drive, int most) {
    for (const ObjectWrite& write : torque_settings(drive.node(), most)) {
      if (drive.write(write.index, write.sub, write.value) != Abort{}) {
        throw std::logic_error("a simulated drive refused object " + std::to_string(write.index));
      }
    }
  }

  LoopbackHub hub_;
  LoopbackBus near_ = hub_.open();
  JoystickOnBus<D> other_;
  Can can_;
};

}  // namespace ebac::can
