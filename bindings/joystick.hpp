#pragma once

#include <memory>
#include <optional>

#include "ebac/rt/shared_hand_target.hpp"
#include "ebac/sensor/shared_force.hpp"
#include "ebac/sim/setup.hpp"
#include "ebac/sim/simulated_device.hpp"
#include "ebac/simulated_drives/joystick.hpp"
#include "fields.hpp"

namespace ebac::python {

using PlantOfDrives = can::Joystick<sensor::ForcePublisher<rt::TargetSubscriber<SimulatedDevice>>>;

/// Node ids of drives on `axes` axes, from `node` on.
inline can::NodeId checked_node(int node, int axes) {
  const int most = can::kLastNode - axes + 1;
  if (node < 1 || node > most) {
    throw std::invalid_argument(range_message("drive", "node", node, "1", 1, most));
  }
  return static_cast<can::NodeId>(node);
}

inline double checked_peak_time(double seconds) {
  const bool fits = seconds >= 0.001 && seconds <= 65.535;  // not a NaN
  if (!fits) {
    throw std::invalid_argument(range_message("drive", "peak_time", seconds, "s", 0.001, 65.535));
  }
  return seconds;
}

template <class Cell>
using Shared = std::optional<std::shared_ptr<Cell>>;

/// The device and hand of a setup behind drives; publishes the force at the handle to `force`, and
/// the hand follows the target in `aim`.
inline PlantOfDrives make_joystick(Setup setup, int first, double peak_time,
                                   const Shared<sensor::SharedForce>& force, bool wait_for_power,
                                   const Shared<rt::SharedHandTarget>& aim) {
  const can::NodeId node = checked_node(first, setup.device.axes());
  setup.device.drive.permille = true;  // what a drive is told in
  setup.timing.delay = 0;              // its delay is that of the bus
  return {
      sensor::ForcePublisher(rt::TargetSubscriber(SimulatedDevice(setup), aim.value_or(nullptr)),
                             force.value_or(nullptr)),
      setup.device, node, checked_peak_time(peak_time), wait_for_power};
}

}  // namespace ebac::python
