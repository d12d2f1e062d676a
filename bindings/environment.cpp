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
        return shape.meet(as_axes(x, n, "x"), as_axes(v, n, "v")).force.head(n);
      },
      py::arg("x"), py::arg("v"), "Force asked for [N] at x [m] and v [m/s], shape (axes,).");
}

}  // namespace

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

}  // namespace ebac::python
