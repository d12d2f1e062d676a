#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "ebac/rt/shared_hand_target.hpp"
#include "ebac/sensor/shared_force.hpp"
#include "ebac/sim/setup.hpp"
#include "ebac/sim/simulated_device.hpp"
#include "ebac/sim/with_machine.hpp"
#include "ebac/simulated_drives/joystick.hpp"
#include "ebac/simulated_drives/patient_plant.hpp"
#include "fields.hpp"
#include "zero.hpp"

namespace ebac::python {

using PlantOfDrives = can::Joystick<
    sensor::ForcePublisher<can::PatientPlant<rt::TargetSubscriber<WithMachine<SimulatedDevice>>>>>;

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

/// One entry of an electronic data sheet: index, sub-index, access ("ro", "wo", "rw"), whether a PDO
/// may carry it, bytes (0 for text), lowest, highest, initial value, initial text.
using SheetRow = std::tuple<std::uint16_t, std::uint8_t, std::string, bool, std::uint8_t,
                            std::int64_t, std::int64_t, std::optional<std::int64_t>, std::string>;

inline std::vector<can::SheetEntry> checked_sheet(const std::vector<SheetRow>& rows) {
  std::vector<can::SheetEntry> sheet;
  sheet.reserve(rows.size());
  for (const auto& [index, sub, access, mappable, width, low, high, initial, text] : rows) {
    if (width > 8) throw std::invalid_argument("sheet: an entry has at most 8 bytes");
    sheet.push_back({.index = index,
                     .sub = sub,
                     .access = access == "rw"   ? can::Access::kRw
                               : access == "wo" ? can::Access::kWo
                                                : can::Access::kRo,
                     .mappable = mappable,
                     .width = width,
                     .low = low,
                     .high = high,
                     .initial = initial.value_or(0),
                     .has_initial = initial.has_value(),
                     .text = text});
  }
  return sheet;
}

template <class Cell>
using Shared = std::optional<std::shared_ptr<Cell>>;

/// The device and hand of a setup behind drives; publishes the force at the handle to `force`, and
/// the hand follows the target in `aim`, or a load takes its place. `zero`: counts of each drive at the device's zero.
inline PlantOfDrives make_joystick(Setup setup, int first, double peak_time,
                                   const Shared<sensor::SharedForce>& force, bool wait_for_power,
                                   const Shared<rt::SharedHandTarget>& aim,
                                   const std::vector<SheetRow>& sheet = {},
                                   const std::vector<std::int64_t>& zero = {},
                                   double longest_step = std::numeric_limits<double>::infinity(),
                                   const std::shared_ptr<DrivenMachine>& load = nullptr) {
  const can::NodeId node = checked_node(first, setup.device.axes());
  setup.device.drive.permille = true;  // what a drive is told in
  setup.timing.delay = 0;              // its delay is that of the bus
  const std::vector<can::SheetEntry> entries = checked_sheet(sheet);
  return {
      sensor::ForcePublisher(
          can::PatientPlant(rt::TargetSubscriber(WithMachine(SimulatedDevice(setup), load,
                                                             std::max(1.0, setup.hand.stiffness)),
                                                 aim.value_or(nullptr)),
                            longest_step),
          force.value_or(nullptr)),
      setup.device,
      node,
      checked_peak_time(peak_time),
      wait_for_power,
      entries,
      zero_of("drive", "zero", zero, setup.device.axes())};
}

}  // namespace ebac::python
