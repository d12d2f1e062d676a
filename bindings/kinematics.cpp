#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "axes_argument.hpp"
#include "bind.hpp"
#include "fields.hpp"

namespace ebac::python {

namespace {

template <class K>
void add_kinematics(py::class_<K>& cls) {
  cls.def_property_readonly(
         "axes", [](const K& k) { return ebac::axes(k); }, "Number of axes.")
      .def_property_readonly(
          "travel", [](const K& k) -> Eigen::VectorXd { return k.travel().head(ebac::axes(k)); },
          "Way of the handle per angle of each joint, in the middle [m], shape (axes,).")
      .def_property_readonly(
          "stops", [](const K& k) -> Eigen::VectorXd { return k.stops().head(ebac::axes(k)); },
          "Largest angle of each joint either way [rad], shape (axes,).")
      .def(
          "forward",
          [](const K& k, const std::vector<double>& q) -> Eigen::VectorXd {
            return k.forward(as_axes(q, ebac::axes(k), "q")).head(ebac::axes(k));
          },
          py::arg("q"), "Return the handle position [m] at joint angles q [rad], shape (axes,).")
      .def(
          "inverse",
          [](const K& k, const std::vector<double>& x) -> Eigen::VectorXd {
            return k.inverse(as_axes(x, ebac::axes(k), "x")).head(ebac::axes(k));
          },
          py::arg("x"), "Return the joint angles [rad] at handle position x [m], shape (axes,).")
      .def(
          "jacobian",
          [](const K& k, const std::vector<double>& q) -> Eigen::MatrixXd {
            return k.jacobian(as_axes(q, ebac::axes(k), "q"))
                .topLeftCorner(ebac::axes(k), ebac::axes(k));
          },
          py::arg("q"), "Return the Jacobian dx/dq [m/rad] at q [rad], shape (axes, axes).")
      .def(
          "transpose",
          [](const K& k, const std::vector<double>& q,
             const std::vector<double>& f) -> Eigen::VectorXd {
            return ebac::transpose(k, as_axes(q, ebac::axes(k), "q"),
                                   as_axes(f, ebac::axes(k), "f"))
                .head(ebac::axes(k));
          },
          py::arg("q"), py::arg("f"),
          "Return the joint torques J^T f [N m] of a handle force f [N].")
      .def(
          "within_limits",
          [](const K& k, const std::vector<double>& q) {
            return ebac::within_limits(k, as_axes(q, ebac::axes(k), "q"));
          },
          py::arg("q"), "Return whether every joint is within its limit.");
}

}  // namespace

void bind_kinematics(py::module_& m) {
  auto linear =
      bind_fields<Linear>(m, "Linear", "n independent axes, x = R q: the device of eq. (6).");
  add_kinematics(linear);
  auto gimbal =
      bind_fields<Gimbal>(m, "Gimbal",
                          "The paper's joystick: a lever of radius R on two crossed axes.\n\nx = R "
                          "sin q1 cos q2, y = R sin q2, z = R cos q1 cos q2.");
  add_kinematics(gimbal);
  auto sliding = bind_fields<SlidingGimbal>(
      m, "SlidingGimbal",
      "Three axes: the gimbal, whose lever slides through its joints.\n\nThe drum of the slide is "
      "the "
      "third joint: the lever is R + slide_radius q3 long. x and y as of a Gimbal; z is "
      "the\nheight "
      "of the handle above where it rests, R' cos q1 cos q2 - R with that length R'.");
  add_kinematics(sliding);
  gimbal.def(
      "height",
      [](const Gimbal& k, const std::vector<double>& q) {
        return k.height(as_axes(q, ebac::axes(k), "q"));
      },
      py::arg("q"), "Return the height z of the handle above the joints [m].");
}

}  // namespace ebac::python
