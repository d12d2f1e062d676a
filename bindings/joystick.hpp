#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "drive_wiring.hpp"
#include "ebac/rt/shared_hand_target.hpp"
#include "ebac/sensor/shared_force.hpp"
#include "ebac/sim/setup.hpp"
#include "ebac/sim/simulated_device.hpp"
#include "ebac/sim/with_machine.hpp"
#include "ebac/simulated_drives/joystick.hpp"
#include "ebac/simulated_drives/patient_plant.hpp"
#include "fields.hpp"

namespace ebac::python {

using PlantOfDrives = can::Joystick<
    sensor::ForcePublisher<can::PatientPlant<rt::TargetSubscriber<WithMachine<SimulatedDevice>>>>>;

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
/// the hand follows the target in `aim`, or a load takes its place.
inline PlantOfDrives make_joystick(Setup setup, const DriveWiring& wiring, double peak_time,
                                   const Shared<sensor::SharedForce>& force, bool wait_for_power,
                                   const Shared<rt::SharedHandTarget>& aim,
                                   double longest_step = std::numeric_limits<double>::infinity(),
                                   const std::shared_ptr<DrivenMachine>& load = nullptr) {
  const CheckedWiring checked(wiring, setup.device.axes());
  setup.device.drive.permille = true;  // what a drive is told in
  setup.timing.delay = 0;              // its delay is that of the bus
  return {
      sensor::ForcePublisher(
          can::PatientPlant(rt::TargetSubscriber(WithMachine(SimulatedDevice(setup), load,
                                                             std::max(1.0, setup.hand.stiffness)),
                                                 aim.value_or(nullptr)),
                            longest_step),
          force.value_or(nullptr)),
      setup.device, checked.wiring(), checked_peak_time(peak_time), wait_for_power};
}

}  // namespace ebac::python
