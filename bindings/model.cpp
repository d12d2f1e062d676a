#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bind.hpp"
#include "ebac/model/device.hpp"
#include "ebac/model/environment.hpp"
#include "ebac/model/hand.hpp"
#include "fields.hpp"

namespace ebac::python {

namespace {

/// A point or a force with as many entries as the device has axes.
Axes as_axes(const std::vector<double>& values, int axes, const char* what) {
  if (values.size() != static_cast<std::size_t>(axes)) {
    throw std::invalid_argument(std::string(what) + " has " + std::to_string(values.size()) +
                                " values: must have " + std::to_string(axes) +
                                ", one for each axis");
  }
  Axes all = Axes::Zero();
  for (std::size_t i = 0; i < values.size(); ++i) all[static_cast<Eigen::Index>(i)] = values[i];
  return all;
}

template <class K>
void add_kinematics(py::class_<K>& cls) {
  cls.def_property_readonly(
         "axes", [](const K& k) { return ebac::axes(k); }, "Number of axes.")
      .def(
          "forward",
          [](const K& k, const std::vector<double>& q) -> Eigen::VectorXd {
            return k.forward(as_axes(q, ebac::axes(k), "q")).head(ebac::axes(k));
          },
          py::arg("q"), "Handle position [m] at joint angles q [rad], shape (axes,).")
      .def(
          "inverse",
          [](const K& k, const std::vector<double>& x) -> Eigen::VectorXd {
            return k.inverse(as_axes(x, ebac::axes(k), "x")).head(ebac::axes(k));
          },
          py::arg("x"), "Joint angles [rad] at handle position x [m], shape (axes,).")
      .def(
          "jacobian",
          [](const K& k, const std::vector<double>& q) -> Eigen::MatrixXd {
            return k.jacobian(as_axes(q, ebac::axes(k), "q"))
                .topLeftCorner(ebac::axes(k), ebac::axes(k));
          },
          py::arg("q"), "dx/dq [m/rad] at q [rad], shape (axes, axes).")
      .def(
          "transpose",
          [](const K& k, const std::vector<double>& q,
             const std::vector<double>& f) -> Eigen::VectorXd {
            return ebac::transpose(k, as_axes(q, ebac::axes(k), "q"),
                                   as_axes(f, ebac::axes(k), "f"))
                .head(ebac::axes(k));
          },
          py::arg("q"), py::arg("f"), "Joint torques J^T f [N m] that show f [N] at the handle.")
      .def(
          "within_limits",
          [](const K& k, const std::vector<double>& q) {
            return ebac::within_limits(k, as_axes(q, ebac::axes(k), "q"));
          },
          py::arg("q"), "Whether every joint is within its limit.");
}

void bind_kinematics(py::module_& m) {
  auto linear =
      bind_fields<Linear>(m, "Linear", "n independent axes, x = R q: the device of eq. (6).");
  add_kinematics(linear);
  auto gimbal =
      bind_fields<Gimbal>(m, "Gimbal",
                          "The paper's joystick: a lever of radius R on two crossed axes.\n\nx = R "
                          "sin q1 cos q2, y = R sin q2, z = R cos q1 cos q2.");
  add_kinematics(gimbal);
  gimbal.def(
      "height",
      [](const Gimbal& k, const std::vector<double>& q) {
        return k.height(as_axes(q, ebac::axes(k), "q"));
      },
      py::arg("q"), "z of the handle [m] above the joints.");
}

void bind_motor(py::module_& m) {
  bind_fields<Motor>(m, "Motor", "A brushed DC motor; defaults: the paper's Maxon RE 30.")
      .def("current", &Motor::current, py::arg("torque"),
           "Current [A] for a torque [N m], eq. (1) in SI.")
      .def("torque", &Motor::torque, py::arg("current"), "Torque [N m] of a current [A].");
  bind_fields<Drive>(m, "Drive", "The drive in front of the motor.")
      .def("peak_current", &Drive::peak_current, py::arg("motor"), "Largest current it sets [A].");
  m.def("copley_current", &copley_current, py::arg("torque_permille"),
        py::arg("continuous_torque_1e5"), py::arg("torque_constant_1e5"),
        "Eq. (1) in Copley's units: I = 0.001 T Tc / Ts [A], T in thousandths of the continuous "
        "torque,\nTc in 1e-5 N m, Ts in 1e-5 N m/A.");
}

void bind_encoder(py::module_& m) {
  bind_fields<Encoder>(m, "Encoder",
                       "An incremental encoder on the motor shaft, behind a counter that wraps.")
      .def_property_readonly("count", &Encoder::count, "One count [rad] of the motor.")
      .def("read", &Encoder::read, py::arg("angle"),
           "What the counter shows at a motor angle [rad].")
      .def("unwrap", &Encoder::unwrap, py::arg("raw"), py::arg("last"),
           "The unwrapped count nearest to `last` that the counter shows as `raw`.");
  auto capstan =
      bind_fields<Capstan>(m, "Capstan", "A cable from the motor's drum to a sector on the lever.");
  capstan.def_property_readonly("ratio", &Capstan::ratio, "Motor angle over joint angle.");
}

py::array_t<double> estimate(const Velocity& estimator, const py::array_t<double>& x, double dt,
                             double count) {
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
        "Velocity [m/s] from positions x [m], shape (n,), sampled every dt [s] with an encoder "
        "step of count [m].");
}

void bind_parts(py::module_& m) {
  bind_fields<Mechanics>(m, "Mechanics",
                         "What moves, told at the handle; every axis is built alike.");
  bind_fields<ForceSensor>(m, "ForceSensor", "A force/torque sensor between handle and hand.");
  bind_fields<Compensation>(
      m, "Compensation",
      "tau_static of eq. (2): gravity, friction and inertia given back to the hand.")
      .def("force", &Compensation::force, py::arg("v"), py::arg("a"),
           "Force [N] that helps a motion of v [m/s] and a [m/s^2]; positive resists +x.")
      .def("damping_left", &Compensation::damping_left, py::arg("damping"), py::arg("coulomb"),
           "Lower bound of the viscous damping left [N s/m], given real damping [N s/m] and "
           "friction [N].");
}

template <class Part>
void take(py::dict& given, const char* name, Part& part) {
  if (!given.contains(name)) return;
  const py::object value = given.attr("pop")(name);
  try {
    part = value.cast<Part>();
  } catch (const py::cast_error&) {
    throw py::type_error("Device." + std::string(name) + " = " +
                         py::cast<std::string>(py::repr(value)) + ": not such a part");
  }
}

DeviceModel make_device(py::dict given) {
  DeviceModel device;
  take(given, "kinematics", device.kinematics);
  take(given, "motor", device.motor);
  take(given, "drive", device.drive);
  take(given, "encoder", device.encoder);
  take(given, "capstan", device.capstan);
  take(given, "mechanics", device.mechanics);
  take(given, "sensor", device.sensor);
  take(given, "velocity", device.velocity);
  take(given, "compensation", device.compensation);
  for (const auto& [key, value] : given) {
    refuse_keyword("Device", py::cast<std::string>(key),
                   {"kinematics", "motor", "drive", "encoder", "capstan", "mechanics", "sensor",
                    "velocity", "compensation"});
  }
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

void bind_device(py::module_& m) {
  py::class_<DeviceModel> cls(
      m, "Device",
      "One haptic device, part by part. The default is the reference device: one straight axis of "
      "0.25 kg and\n2 N s/m, built from the paper's motor, encoder and capstan.");
  def_init(
      cls, [](const py::kwargs& given) { return make_device(py::dict(given)); },
      "__init__(self, *, kinematics: Linear | Gimbal = ..., motor: Motor = ..., drive: Drive "
      "= ..., encoder: Encoder = ..., capstan: Capstan = ..., mechanics: Mechanics = ..., "
      "sensor: ForceSensor = ..., velocity: BackwardDifference | LowPass | AdaptiveWindow = "
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
      .def_property_readonly("count", &DeviceModel::count, "One encoder count at the handle [m].")
      .def_property_readonly("mass", &DeviceModel::mass, "Mass at the handle, M_h [kg].")
      .def_property_readonly("reflected_mass", &DeviceModel::reflected_mass,
                             "Rotor's part of the mass [kg].")
      .def_property_readonly("continuous_force", &DeviceModel::continuous_force,
                             "Force at rated torque [N].")
      .def_property_readonly("peak_force", &DeviceModel::peak_force, "Largest force [N].")
      .def_property_readonly("facts", &DeviceModel::facts, "What laws are designed from.")
      .def("force", &DeviceModel::force, py::arg("current"), "Handle force [N] of a current [A].")
      .def("as_dict", &device_dict, "Parts by name.");
  add_value_methods(cls);
}

void bind_paths(py::module_& m) {
  bind_fields<Step>(m, "Step", "Wants to be at `target` from time `at` on.");
  bind_fields<MinimumJerk>(m, "MinimumJerk",
                           "Reaches `target` along the smoothest path (Flash and Hogan 1985).");
  bind_fields<Sine>(m, "Sine", "Swings around a centre.");
  bind_fields<Tapping>(m, "Tapping", "Square tapping: half a period at `target`, half at `rest`.");
  py::class_<Recorded> recorded(m, "Recorded",
                                "A path from a log: straight between its points, constant beyond.");
  recorded
      .def(py::init<std::vector<double>, std::vector<double>>(), py::kw_only(), py::arg("t"),
           py::arg("x"), "Times [s], strictly rising, and positions [m], as many.")
      .def_property_readonly("t", &Recorded::t, "Times [s].")
      .def_property_readonly("x", &Recorded::x, "Positions [m].")
      .def(
          "as_dict",
          [](const Recorded& r) -> Values {
            using namespace py::literals;
            return py::dict("t"_a = r.t(), "x"_a = r.x());
          },
          "Parameters by name.");
  add_value_methods(recorded);
}

using Paths = std::variant<Path, std::vector<Path>>;

void set_paths(Hand& hand, const Paths& paths) {
  if (const auto* one = std::get_if<Path>(&paths)) {
    hand.path[0] = *one;
    return;
  }
  const auto& many = std::get<std::vector<Path>>(paths);
  if (many.empty() || many.size() > hand.path.size()) {
    throw std::invalid_argument("Hand.path has " + std::to_string(many.size()) +
                                " paths: must have 1 to " + std::to_string(hand.path.size()) +
                                ", one for each axis");
  }
  std::copy(many.begin(), many.end(), hand.path.begin());
}

void bind_hand(py::module_& m) {
  py::class_<Hand> cls(m, "Hand",
                       ("The operator of eq. (4), (5): mass, damper and spring pulled along an "
                        "intended path.\n\n`path` is one path, for the first axis, or one for each "
                        "axis; the others stay at 0." +
                        parameter_table<Hand>())
                           .c_str());
  def_init(
      cls,
      [](const py::kwargs& given) {
        Hand hand;
        for (const auto& [key, item] : given) {
          const auto word = py::cast<std::string>(key);
          if (word == "path") {
            try {
              set_paths(hand, item.cast<Paths>());
            } catch (const py::cast_error&) {
              throw py::type_error(
                  "Hand.path = " + py::cast<std::string>(py::repr(item)) +
                  ": must be Step, MinimumJerk, Sine, Tapping, Recorded, or a list of them");
            }
          } else if (!set_field(hand, "Hand", word, item)) {
            auto known = field_names<Hand>();
            known.emplace_back("path");
            refuse_keyword("Hand", word, known);
          }
        }
        check(hand, "Hand");
        return hand;
      },
      "__init__(self, *" + signature(Hand{}) +
          ", path: Step | MinimumJerk | Sine | Tapping | Recorded | typing.Sequence[Step | "
          "MinimumJerk | Sine | Tapping | Recorded] = ...) -> None");
  add_members<Hand>(cls, [](const Hand& hand) -> const Hand& { return hand; });
  cls.def_property_readonly(
         "path",
         [](const Hand& hand) { return std::make_tuple(hand.path[0], hand.path[1], hand.path[2]); },
         "Intended path of each axis.")
      .def(
          "target",
          [](const Hand& hand, double t, int axis) {
            if (axis < 0 || axis >= kMaxAxes) {
              throw std::invalid_argument("axis = " + std::to_string(axis) + ": must lie in [0, " +
                                          std::to_string(kMaxAxes - 1) + "]");
            }
            return hand.target(axis, t, 1e-3).x;
          },
          py::arg("t"), py::arg("axis") = 0, "X0(t) [m], tremor included, at time t [s].")
      .def(
          "as_dict",
          [](const Hand& hand) {
            Values values = values_of(hand);
            values["path"] = py::tuple(py::cast(hand.path));
            return values;
          },
          "Parameters by name.");
  add_value_methods(cls);
}

template <class Shape, class Class>
void add_force(Class& cls) {
  cls.def(
      "force",
      [](const Shape& shape, const std::vector<double>& x,
         const std::vector<double>& v) -> Eigen::VectorXd {
        const auto n = static_cast<int>(x.size());
        if (n < 1 || n > kMaxAxes)
          throw std::invalid_argument("x must have 1 to 3 values, one for each axis");
        return shape.meet(as_axes(x, n, "x"), as_axes(v, n, "v")).force.head(n);
      },
      py::arg("x"), py::arg("v"), "Force asked for [N] at x [m] and v [m/s], shape (axes,).");
}

void bind_environment(py::module_& m) {
  auto free = bind_fields<Free>(m, "Free", "Nothing to touch.");
  add_force<Free>(free);
  auto wall = bind_fields<Wall>(m, "Wall", "A flat wall, eq. (12), that never pulls.");
  add_force<Wall>(wall);
  auto disc = bind_fields<Disc>(m, "Disc", "A round pillar in the plane, met from outside.");
  add_force<Disc>(disc);
  py::class_<Corner> corner(m, "Corner", "Two walls that meet: each pushes along its own normal.");
  corner
      .def(py::init([](const Wall& first, const Wall& second) { return Corner{first, second}; }),
           py::kw_only(), py::arg("first") = Corner{}.first, py::arg("second") = Corner{}.second)
      .def_readonly("first", &Corner::first, "One wall.")
      .def_readonly("second", &Corner::second, "The other wall.")
      .def(
          "as_dict",
          [](const Corner& c) -> Values {
            using namespace py::literals;
            return py::dict("first"_a = c.first, "second"_a = c.second);
          },
          "Parameters by name.");
  add_force<Corner>(corner);
  add_value_methods(corner);
}

}  // namespace

void bind_model(py::module_& m) {
  bind_kinematics(m);
  bind_motor(m);
  bind_encoder(m);
  bind_velocity(m);
  bind_parts(m);
  bind_device(m);
  bind_paths(m);
  bind_hand(m);
  bind_environment(m);
}

}  // namespace ebac::python
