#include "ebac/model/environment.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "axes_argument.hpp"
#include "bind.hpp"
#include "fields.hpp"

namespace ebac::python {

namespace {

template <class Shape, class Class>
void add_force(Class& cls) {
  cls.def(
      "force",
      [](const Shape& shape, const std::vector<double>& x,
         const std::vector<double>& v) -> Eigen::VectorXd {
        const auto n = static_cast<int>(x.size());
        if (n < 1 || n > kMaxAxes)
          throw std::invalid_argument("x must have 1 to 3 values, one for each axis");
        return shape.contact(as_axes(x, n, "x"), as_axes(v, n, "v")).force.head(n);
      },
      py::arg("x"), py::arg("v"),
      "Return the force [N] at position x [m] and velocity v [m/s], shape (axes,).");
}

}  // namespace

void bind_environment(py::module_& m) {
  auto free = bind_fields<Free>(m, "Free", "Free space: no force.");
  add_force<Free>(free);
  auto wall = bind_fields<Wall>(m, "Wall", "A flat wall, eq. (12), which never pulls.");
  add_force<Wall>(wall);
  auto disc = bind_fields<Disc>(m, "Disc", "A round pillar in the plane, touched from outside.");
  add_force<Disc>(disc);
  py::class_<Corner> corner(m, "Corner",
                            "Two intersecting walls: each pushes along its own normal.");
  def_init(
      corner,
      [](const py::args& args, const py::kwargs& keywords) {
        const std::vector<std::string> known{"first", "second"};
        refuse_positional("Corner", args, known);
        Corner made;
        py::dict given(keywords);
        take_part(given, "Corner", "first", made.first, "a Wall");
        take_part(given, "Corner", "second", made.second, "a Wall");
        refuse_rest("Corner", given, known);
        if (made.first.motion_amplitude != 0 || made.second.motion_amplitude != 0) {
          throw std::invalid_argument("Corner: motion_amplitude of a wall must be 0 m");
        }
        return made;
      },
      "__init__(self: ebac._core.Corner, *, first: ebac._core.Wall = " +
          represent(py::cast(Corner{}.first)) +
          ", second: ebac._core.Wall = " + represent(py::cast(Corner{}.second)) + ") -> None\n");
  add_signature(corner, FieldTable{},
                {{"first", py::cast(Corner{}.first)}, {"second", py::cast(Corner{}.second)}});
  corner.def_readonly("first", &Corner::first, "One wall.")
      .def_readonly("second", &Corner::second, "The other wall.")
      .def(
          "as_dict",
          [](const Corner& c) -> Values {
            using namespace py::literals;
            return py::dict("first"_a = c.first, "second"_a = c.second);
          },
          "Return the parameters by name.");
  add_force<Corner>(corner);
  add_value_methods(corner);
}

}  // namespace ebac::python
