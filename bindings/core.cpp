#include <pybind11/native_enum.h>

#include "bind.hpp"
#include "ebac/core/device_facts.hpp"
#include "ebac/core/sample.hpp"
#include "ebac/core/timing.hpp"
#include "fields.hpp"

namespace ebac::python {

namespace {

void bind_field_info(py::module_& m) {
  py::class_<FieldInfo>(m, "Field", "One parameter or column: name, unit, meaning, default, range.")
      .def_readonly("name", &FieldInfo::name, "Name.")
      .def_readonly("unit", &FieldInfo::unit, "SI unit; '1' for a pure number.")
      .def_readonly("meaning", &FieldInfo::meaning, "Meaning.")
      .def_readonly("kind", &FieldInfo::kind, "Python type.")
      .def_readonly("default", &FieldInfo::initial, "Default.")
      .def_readonly("low", &FieldInfo::low, "Smallest value allowed.")
      .def_readonly("high", &FieldInfo::high, "Largest value allowed.")
      .def("__repr__", [](const FieldInfo& f) {
        return "Field(" + f.name + " [" + f.unit + "]: " + f.meaning + ")";
      });
}

void bind_fault(py::module_& m) {
  py::native_enum<Fault>(m, "Fault", "enum.IntEnum", "Why a loop stopped; the first one latches.")
      .value("NONE", Fault::kNone)
      .value("POSITION_NOT_FINITE", Fault::kPositionNotFinite)
      .value("FORCE_NOT_FINITE", Fault::kForceNotFinite)
      .value("ENVIRONMENT_NOT_FINITE", Fault::kEnvironmentNotFinite)
      .value("LAW_NOT_FINITE", Fault::kLawNotFinite)
      .value("TORQUE_NOT_FINITE", Fault::kTorqueNotFinite)
      .value("DEVICE", Fault::kDevice)
      .value("DRIVE_FAULT", Fault::kDriveFault)
      .value("DRIVE_DISABLED", Fault::kDriveDisabled)
      .value("DRIVE_SILENT", Fault::kDriveSilent)
      .value("DRIVE_EMERGENCY", Fault::kDriveEmergency)
      .value("HEARTBEAT_LOST", Fault::kHeartbeatLost)
      .value("BUS_DOWN", Fault::kBusDown)
      .value("ENCODER_JUMP", Fault::kEncoderJump)
      .value("OVERSPEED", Fault::kOverspeed)
      .value("WORKSPACE", Fault::kWorkspace)
      .value("FORCE_STALE", Fault::kForceStale)
      .value("FORCE_SATURATED", Fault::kForceSaturated)
      .value("FORCE_DISCONNECTED", Fault::kForceDisconnected)
      .value("OVERRUNS", Fault::kOverruns)
      .value("FORCE_ERROR", Fault::kForceError)
      .value("STARVED", Fault::kStarved)
      .value("TORQUE_MISMATCH", Fault::kTorqueMismatch)
      .value("SECOND_MASTER", Fault::kSecondMaster)
      .value("ENCODER_FROZEN", Fault::kEncoderFrozen)
      .value("TORQUE_REVERSED", Fault::kTorqueReversed)
      .value("MOTION_IMPLAUSIBLE", Fault::kMotionImplausible)
      .value("DUPLICATE_NODE", Fault::kDuplicateNode)
      .finalize();
}

void bind_states(py::module_& m) {
  py::native_enum<LoopState>(m, "LoopState", "enum.IntEnum", "State of a loop.")
      .value("IDLE", LoopState::kIdle)
      .value("ARM", LoopState::kArm)
      .value("RUN", LoopState::kRun)
      .value("STOP", LoopState::kStop)
      .value("FAULT", LoopState::kFault)
      .finalize();
  py::native_enum<Limited>(m, "Limited", "enum.IntFlag",
                           "Reasons for which a current was limited in a tick.")
      .value("PEAK", Limited::kPeak)
      .value("THERMAL", Limited::kThermal)
      .value("SLEW", Limited::kSlew)
      .value("EDGE", Limited::kEdge)
      .value("RAMP", Limited::kRamp)
      .value("NOT_FINITE", Limited::kNotFinite)
      .finalize();
  py::native_enum<Fallback>(m, "Fallback", "enum.IntEnum",
                            "Why the observer's estimate is not used in a tick.")
      .value("NONE", Fallback::kNone)
      .value("OFF", Fallback::kOff)
      .value("FORCE_STALE", Fallback::kForceStale)
      .value("FORCE_STATUS", Fallback::kForceStatus)
      .value("MODEL", Fallback::kModel)
      .value("ACCOUNT", Fallback::kAccount)
      .finalize();
}

/// A port is what a law reads, so a law written in Python, or stepped from there, needs to fill one
/// in.
void bind_port(py::module_& m) {
  bind_fields<Estimate>(m, "Estimate",
                        "State of a device at one port, as the observer estimates it.");
  auto cls = bind_fields<Port>(m, "Port", "Input of a law: one axis in one tick.");
  for (const FieldRow& field : field_table<Port>().rows) {
    cls.def_property(
        std::string(field.name).c_str(),
        [row = &field](const Port& port) { return row->in<double>(&port); },
        [row = &field](Port& port, double value) { row->in<double>(&port) = value; },
        describe(field).c_str());
  }
  cls.def_readwrite("est", &Port::est, "State that the observer estimates.");
}

}  // namespace

void bind_core(py::module_& m) {
  m.def("_rebuild", &rebuild);
  bind_field_info(m);
  bind_fault(m);
  bind_states(m);
  bind_port(m);
  bind_fields<Timing>(m, "Timing", "Timing for which a law is designed.");
  bind_fields<DeviceFacts>(m, "DeviceFacts", "Facts about a device from which laws are designed.");
}

}  // namespace ebac::python
