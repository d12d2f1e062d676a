#include <pybind11/native_enum.h>
#include <pybind11/stl.h>

#include <tuple>

#include "bind.hpp"
#include "ebac/canopen/eds.hpp"
#include "joystick.hpp"

namespace ebac::python {

namespace {

using can::SimulatedDrive;

constexpr double kDay = 86400;  // s

/// Identifier, data, whether it asks for a frame: of eleven bits, as CANopen has them.
can::Frame frame_of(std::uint32_t id, const py::bytes& data, bool remote) {
  const std::string_view bytes = data;
  if (id > 0x7FF || bytes.size() > can::Frame::kMaxSize) {
    throw std::invalid_argument("frame: id = " + std::to_string(id) + " with " +
                                std::to_string(bytes.size()) +
                                " bytes: must be at most 2047, with at most 8 bytes");
  }
  can::Frame frame{.id = id, .size = static_cast<std::uint8_t>(bytes.size()), .remote = remote};
  std::copy(bytes.begin(), bytes.end(), frame.data.begin());
  return frame;
}

template <class Node>
std::vector<std::tuple<std::uint32_t, py::bytes>> take_all(Node& node) {
  std::vector<std::tuple<std::uint32_t, py::bytes>> frames;
  can::Frame frame;
  while (node.take(frame)) {
    frames.emplace_back(frame.id,
                        py::bytes(reinterpret_cast<const char*>(frame.data.data()), frame.size));
  }
  return frames;
}

double checked_time(double seconds) {
  const bool fits = seconds >= 0 && seconds <= kDay;  // not a NaN
  if (!fits) {
    throw std::invalid_argument(range_message("elapse", "seconds", seconds, "s", 0, kDay));
  }
  return seconds;
}

void bind_enums(py::module_& m) {
  py::native_enum<can::Condition>(m, "DriveCondition", "enum.IntFlag",
                                  "Conditions that can be injected into a simulated drive.")
      .value("OVER_VOLTAGE", can::Condition::kOverVoltage)
      .value("ENCODER_LOST", can::Condition::kEncoderLost)
      .value("OVER_TEMPERATURE", can::Condition::kOverTemperature)
      .value("SILENT", can::Condition::kSilent)
      .value("UNDER_VOLTAGE", can::Condition::kUnderVoltage)
      .value("MOTOR_TEMPERATURE", can::Condition::kMotorTemperature)
      .value("SHORT_CIRCUIT", can::Condition::kShortCircuit)
      .value("TORQUE_OFF", can::Condition::kTorqueOff)
      .value("ENABLE_MISSING", can::Condition::kEnableMissing)
      .value("BRAKE_STUCK", can::Condition::kBrakeStuck)
      .finalize();
  py::native_enum<can::DriveState>(m, "DriveState", "enum.IntEnum",
                                   "State of a simulated drive (CiA 402).")
      .value("NOT_READY_TO_SWITCH_ON", can::DriveState::kNotReady)
      .value("SWITCH_ON_DISABLED", can::DriveState::kSwitchOnDisabled)
      .value("READY_TO_SWITCH_ON", can::DriveState::kReady)
      .value("SWITCHED_ON", can::DriveState::kSwitchedOn)
      .value("OPERATION_ENABLED", can::DriveState::kOperationEnabled)
      .value("QUICK_STOP_ACTIVE", can::DriveState::kQuickStopActive)
      .value("FAULT_REACTION_ACTIVE", can::DriveState::kFaultReaction)
      .value("FAULT", can::DriveState::kFault)
      .finalize();
}

/// What a drive and a joystick share: frames in, time, frames out.
template <class Node, class Class, class Elapse>
void def_frames(Class& cls, Elapse elapse) {
  cls.def(
         "receive",
         [](Node& node, std::uint32_t id, const py::bytes& data, bool remote) {
           node.receive(frame_of(id, data, remote));
         },
         py::arg("id"), py::arg("data") = py::bytes(), py::kw_only(), py::arg("remote") = false,
         "Receive one frame from the bus.")
      .def("elapse", elapse, py::arg("seconds"), "Advance time by `seconds` [s].")
      .def("take", &take_all<Node>, "Return all waiting answers as (id, data).");
}

void bind_simulated_drive(py::module_& m) {
  py::class_<SimulatedDrive> cls(
      m, "SimulatedDrive",
      "A simulated CANopen servo drive without a motor: receives frames, advances time, answers.");
  cls.def(py::init([](int node, const Motor& motor, const Drive& drive, double peak_time,
                      const std::vector<SheetRow>& sheet) {
            const std::vector<can::SheetEntry> entries = checked_sheet(sheet);
            return SimulatedDrive({.node = checked_node(node),
                                   .motor = motor,
                                   .drive = drive,
                                   .peak_time = checked_peak_time(peak_time),
                                   .sheet = entries});
          }),
          py::kw_only(), py::arg("node") = 1, py::arg("motor") = Motor{},
          py::arg("drive") = Drive{}, py::arg("peak_time") = 2.0,
          py::arg("sheet") = std::vector<SheetRow>{})
      .def_property_readonly("node", &SimulatedDrive::node, "Node number.")
      .def_property_readonly("state", &SimulatedDrive::state, "State of CiA 402.")
      .def_property_readonly("current", &SimulatedDrive::current, "Motor current [A].")
      .def(
          "eds", [](const SimulatedDrive& drive) { return can::eds(drive.objects()); },
          "Electronic data sheet (CiA 306).")
      .def("set_position", &SimulatedDrive::set_position, py::arg("counts"),
           "Set the encoder to `counts`.")
      .def("set_condition", &SimulatedDrive::set_condition, py::arg("condition"),
           py::arg("present"), "Inject a condition, or remove it.");
  def_frames<SimulatedDrive>(cls, [](SimulatedDrive& drive, double seconds) {
    drive.elapse(std::llround(checked_time(seconds) * 1e9));
  });
}

void bind_joystick(py::module_& m) {
  py::class_<DriveWiring>(
      m, "DriveWiring",
      "How simulated drives are set on their bus and connected to a device: for each axis the node "
      "id (1 to\n127; default 1, 2, 3), the rows of an electronic data sheet, the counts shown at "
      "the device's zero, and\nthe signs of motor and encoder (1 or -1). An empty list leaves the "
      "default.")
      .def(py::init([](std::vector<int> nodes, std::vector<std::vector<SheetRow>> sheets,
                       std::vector<std::int64_t> zero, std::vector<int> motor,
                       std::vector<int> encoder) {
             return DriveWiring{std::move(nodes), std::move(sheets), std::move(zero),
                                std::move(motor), std::move(encoder)};
           }),
           py::kw_only(), py::arg("nodes") = std::vector<int>{},
           py::arg("sheets") = std::vector<std::vector<SheetRow>>{},
           py::arg("zero") = std::vector<std::int64_t>{}, py::arg("motor") = std::vector<int>{},
           py::arg("encoder") = std::vector<int>{});
  py::class_<PlantOfDrives> cls(m, "Joystick",
                                "Simulated drives on the axes of one simulated device and hand.");
  cls.def(py::init([](const Setup& setup, const DriveWiring& wiring, double peak_time,
                      const Shared<sensor::SharedForce>& force, bool wait_for_power,
                      const Shared<rt::SharedHandTarget>& aim, double longest_step) {
            return make_joystick(setup, wiring, peak_time, force, wait_for_power, aim,
                                 longest_step);
          }),
          py::arg("setup"), py::kw_only(), py::arg_v("wiring", DriveWiring{}, "DriveWiring()"),
          py::arg("peak_time") = 2.0, py::arg("force") = py::none(),
          py::arg("wait_for_power") = false, py::arg("aim") = py::none(),
          py::arg("longest_step") = std::numeric_limits<double>::infinity())
      .def_property_readonly("axes", &PlantOfDrives::axes, "Number of axes.")
      .def(
          "drive",
          [](PlantOfDrives& joystick, std::size_t axis) -> SimulatedDrive& {
            if (axis >= joystick.axes()) {
              throw py::index_error("axis " + std::to_string(axis) + ": the joystick has " +
                                    std::to_string(joystick.axes()));
            }
            return joystick.drive(axis);
          },
          py::arg("axis") = 0, py::return_value_policy::reference_internal, "Drive of one axis.")
      .def(
          "truth",
          [](const PlantOfDrives& joystick, std::size_t axis) {
            if (axis >= joystick.axes()) {
              throw py::index_error("axis " + std::to_string(axis) + ": the joystick has " +
                                    std::to_string(joystick.axes()));
            }
            return joystick.plant().device().device().device().state(axis);
          },
          py::arg("axis") = 0, "Return the true state of one axis.");
  def_frames<PlantOfDrives>(
      cls, [](PlantOfDrives& joystick, double seconds) { joystick.elapse(checked_time(seconds)); });
}

/// The drive's own table, for a test against another.
std::vector<std::vector<can::DriveState>> transitions() {
  std::vector<std::vector<can::DriveState>> rows;
  rows.reserve(can::kTransitions.size());
  for (const auto& row : can::kTransitions) rows.emplace_back(row.begin(), row.end());
  return rows;
}

}  // namespace

void bind_drives(py::module_& m) {
  bind_enums(m);
  bind_simulated_drive(m);
  bind_joystick(m);
  m.def(
      "_drive_transitions", &transitions,
      "The simulated drive's table: a row per state; none, disable voltage, quick stop, shutdown, "
      "switch on, enable operation, fault reset.");
}

}  // namespace ebac::python
