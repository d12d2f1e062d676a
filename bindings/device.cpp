#include "ebac/model/device.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bind.hpp"
#include "ebac/core/check.hpp"
#include "ebac/loop/observer_params.hpp"
#include "fields.hpp"

namespace ebac::python {

namespace {

void bind_motor(py::module_& m) {
  bind_fields<Motor>(m, "Motor", "A brushed DC motor; defaults: the paper's Maxon RE 30.")
      .def("current", &Motor::current, py::arg("torque"),
           "Return the current [A] for a torque [N m], eq. (1) in SI.")
      .def("torque", &Motor::torque, py::arg("current"),
           "Return the torque [N m] of a current [A].");
  bind_fields<Drive>(m, "Drive", "The drive in front of the motor.")
      .def("peak_current", &Drive::peak_current, py::arg("motor"),
           "Return the largest current of the drive [A].");
  m.def("copley_current", &copley_current, py::arg("torque_permille"),
        py::arg("continuous_torque_1e5"), py::arg("torque_constant_1e5"),
        "Eq. (1) in Copley's units: I = 0.001 T Tc / Ts [A], T in thousandths of the continuous "
        "torque,\nTc in 1e-5 N m, Ts in 1e-5 N m/A.");
}

void bind_encoder(py::module_& m) {
  bind_fields<Encoder>(m, "Encoder",
                       "An incremental encoder on the motor shaft, behind a counter that wraps.")
      .def_property_readonly("count", &Encoder::count, "One count [rad] of the motor.")
      .def("read", &Encoder::read, py::arg("angle"), "Return the counter at a motor angle [rad].")
      .def("unwrap", &Encoder::unwrap, py::arg("raw"), py::arg("last"),
           "Return the count nearest to `last` whose wrapped value is `raw`.");
  auto capstan =
      bind_fields<Capstan>(m, "Capstan", "A cable from the motor's drum to a sector on the lever.");
  capstan.def_property_readonly("ratio", &Capstan::ratio, "Motor angle over joint angle.");
}

/// Refuses what no estimate can be made with; NaN is outside any range.
void check_estimate(const char* name, double value, const char* unit, double low, double high) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(range_message("estimate_velocity", name, value, unit, low, high));
}

py::array_t<double> estimate(const Velocity& estimator, const py::array_t<double>& x, double dt,
                             double count) {
  check_estimate("dt", dt, "s", 1e-6, 3600);
  check_estimate("count", count, "m", 0, 1);
  py::array_t<double> v(x.size());
  const auto in = x.unchecked<1>();
  auto out = v.mutable_unchecked<1>();
  VelocityState state;
  for (py::ssize_t i = 0; i < x.size(); ++i) {
    out(i) =
        state.update(estimator, in(i), i > 0 ? in(i) - in(i - 1) : 0.0, i > 0 ? dt : 0.0, count);
  }
  return v;
}

void bind_velocity(py::module_& m) {
  bind_fields<BackwardDifference>(m, "BackwardDifference",
                                  "v = dx / dt: no lag, one count of noise.");
  bind_fields<LowPass>(m, "LowPass", "Backward difference through a first-order low-pass.");
  bind_fields<AdaptiveWindow>(
      m, "AdaptiveWindow", "First-order adaptive windowing (Janabi-Sharifi, Hayward, Chen 2000).");
  m.def("estimate_velocity", &estimate, py::arg("estimator"), py::arg("x"), py::arg("dt"),
        py::arg("count"),
        "Velocity [m/s] from positions x [m], shape (n,), sampled every dt [s], 1e-6 to 3600, with "
        "an encoder step of count [m], 0 to 1.");
}

void bind_parts(py::module_& m) {
  bind_fields<Mechanics>(m, "Mechanics",
                         "Moving parts, referred to the handle; every axis is built alike.");
  bind_fields<ForceSensor>(m, "ForceSensor", "A force/torque sensor between handle and hand.");
  bind_fields<Compensation>(
      m, "Compensation",
      "Static compensation (tau_static of eq. (2)): gravity, friction and inertia.")
      .def(
          "force", &Compensation::force, py::arg("v"), py::arg("a"),
          "Return the force [N] that helps a motion of v [m/s] and a [m/s^2]; positive resists +x.")
      .def("damping_left", &Compensation::damping_left, py::arg("damping"), py::arg("coulomb"),
           "Lower bound of the viscous damping left [N s/m], given real damping [N s/m] and "
           "friction [N].");
}

const std::vector<std::string>& part_names() {
  static const std::vector<std::string> kParts{"kinematics", "motor",    "drive",
                                               "encoder",    "capstan",  "mechanics",
                                               "sensor",     "velocity", "compensation"};
  return kParts;
}

DeviceModel make_device(const py::args& args, const py::kwargs& keywords) {
  refuse_positional("Device", args, part_names());
  DeviceModel device;
  py::dict given(keywords);
  const auto take = [&](const char* name, auto& part, const char* kind) {
    take_part(given, "Device", name, part, kind);
  };
  take("kinematics", device.kinematics, "Linear, Gimbal or SlidingGimbal");
  take("motor", device.motor, "a Motor");
  take("drive", device.drive, "a Drive");
  take("encoder", device.encoder, "an Encoder");
  take("capstan", device.capstan, "a Capstan");
  take("mechanics", device.mechanics, "Mechanics");
  if (given.contains("sensor") && given["sensor"].is_none()) {
    given["sensor"] = ForceSensor{.fitted = false};
  }
  take("sensor", device.sensor, "a ForceSensor, or None for a device without one");
  take("velocity", device.velocity, "BackwardDifference, LowPass or AdaptiveWindow");
  take("compensation", device.compensation, "a Compensation");
  refuse_rest("Device", given, part_names());
  check_device(device);
  return device;
}

Values device_dict(const DeviceModel& d) {
  using namespace py::literals;
  return py::dict("kinematics"_a = d.kinematics, "motor"_a = d.motor, "drive"_a = d.drive,
                  "encoder"_a = d.encoder, "capstan"_a = d.capstan, "mechanics"_a = d.mechanics,
                  "sensor"_a = d.sensor, "velocity"_a = d.velocity,
                  "compensation"_a = d.compensation);
}

/// A property of its first axis.
template <double (DeviceModel::*Of)(int) const EBAC_RT>
double first_axis(const DeviceModel& device) {
  return (device.*Of)(0);
}

/// The way from the model of a device to the device itself, which Python opens.
void bind_open(py::class_<DeviceModel>& cls) {
  const OwnSignatures own;
  cls.def_static(
      "open",
      [](const py::args& args, const py::kwargs& more) {
        return py::module_::import("ebac.hardware").attr("OpenDevice").attr("open")(*args, **more);
      },
      "open(configuration: typing.Any, *, simulate: bool = False, detached: bool = False) -> "
      "ebac.hardware.OpenDevice\n\n"
      "Opens the drives of a configuration, or of its TOML file: `with Device.open(file) as "
      "device`.");
}

void bind_device(py::module_& m) {
  py::class_<DeviceModel> cls(
      m, "Device",
      "One haptic device, part by part. The default is the reference device: one straight axis of "
      "0.25 kg and\n2 N s/m, built from the paper's motor, encoder and capstan.");
  def_init(
      cls, &make_device,
      "__init__(self, *, kinematics: Linear | Gimbal | SlidingGimbal = ..., motor: Motor = "
      "..., drive: Drive "
      "= ..., encoder: Encoder = ..., capstan: Capstan = ..., mechanics: Mechanics = ..., "
      "sensor: ForceSensor | None = ..., velocity: BackwardDifference | LowPass | AdaptiveWindow = "
      "..., compensation: Compensation = ...) -> None");
  cls.def_readonly("kinematics", &DeviceModel::kinematics, "Joints to handle.")
      .def_readonly("motor", &DeviceModel::motor, "Motor of each axis.")
      .def_readonly("drive", &DeviceModel::drive, "Drive of each axis.")
      .def_readonly("encoder", &DeviceModel::encoder, "Encoder of each axis.")
      .def_readonly("capstan", &DeviceModel::capstan, "Transmission of each axis.")
      .def_readonly("mechanics", &DeviceModel::mechanics, "Masses, damping, friction.")
      .def_readonly("sensor", &DeviceModel::sensor, "Force sensor.")
      .def_readonly("velocity", &DeviceModel::velocity, "Velocity estimator.")
      .def_readonly("compensation", &DeviceModel::compensation, "Static compensation of eq. (2).")
      .def_property_readonly("axes", &DeviceModel::axes, "Number of axes.")
      .def_property_readonly("radius", &DeviceModel::radius, "Lever radius [m].")
      .def_property_readonly("count", first_axis<&DeviceModel::count>,
                             "One encoder count at the handle [m]; this and the next four: in the "
                             "middle, on the first axis.")
      .def_property_readonly("mass", first_axis<&DeviceModel::mass>,
                             "Mass at the handle, M_h [kg].")
      .def_property_readonly("reflected_mass", first_axis<&DeviceModel::reflected_mass>,
                             "Rotor's part of the mass [kg].")
      .def_property_readonly("continuous_force", first_axis<&DeviceModel::continuous_force>,
                             "Force at rated torque [N].")
      .def_property_readonly("peak_force", first_axis<&DeviceModel::peak_force>,
                             "Largest force [N].")
      .def_property_readonly("facts", &DeviceModel::facts, "Facts from which laws are designed.")
      .def(
          "force", [](const DeviceModel& d, double current) { return d.force(current); },
          py::arg("current"), "Return the handle force [N] of a current [A].")
      .def("as_dict", &device_dict, "Return the parts by name.");
  add_value_methods(cls);
  std::vector<std::pair<std::string, py::object>> parts;
  for (const auto& [name, part] : device_dict(DeviceModel{})) {
    parts.emplace_back(py::cast<std::string>(name), py::reinterpret_borrow<py::object>(part));
  }
  add_signature(cls, FieldTable{}, parts);
  bind_open(cls);
}

void bind_observer(py::module_& m) {
  auto cls = bind_fields<ObserverParams>(
      m, "Observer",
      "State of the device from encoder, force sensor and currents, estimated in every tick of a "
      "loop.");
  cls.def_static(
      "of", &ObserverParams::of, py::arg("device"), py::arg("timing"),
      "Return the observer of a device whose commands act with the delay of `timing`. It "
      "counts with 0.8 of the device's Coulomb friction, and of a fine encoder with counts of "
      "1.1 N dt^2 / mass.");
}

}  // namespace

/// The parts first: a device is made of them.
void bind_devices(py::module_& m) {
  bind_motor(m);
  bind_encoder(m);
  bind_velocity(m);
  bind_parts(m);
  bind_device(m);
  bind_observer(m);
}

}  // namespace ebac::python
