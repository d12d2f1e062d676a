#include "ebac/model/hand.hpp"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bind.hpp"
#include "fields.hpp"

namespace ebac::python {

namespace {

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

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

void require_axis(int axis) {
  if (axis >= 0 && axis < kMaxAxes) return;
  throw std::invalid_argument("axis = " + std::to_string(axis) + ": must lie in [0, " +
                              std::to_string(kMaxAxes - 1) + "]");
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
            require_axis(axis);
            return hand.target(axis, t, 1e-3).x;
          },
          py::arg("t"), py::arg("axis") = 0, "X0(t) [m], tremor included, at time t [s].")
      .def(
          "pull",
          [](const Hand& hand, const Numbers& t, const Numbers& x, int axis) {
            require_axis(axis);
            return py::vectorize([&hand, axis](double at, double where) {
              return hand.pull(axis, at, where);
            })(t, x);
          },
          py::arg("t"), py::arg("x"), py::arg("axis") = 0,
          "How hard it pulls [N], |K0 (X0(t) - x)|, at times t [s] and positions x [m].")
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

}  // namespace

void bind_hands(py::module_& m) {
  bind_paths(m);
  bind_hand(m);
}

}  // namespace ebac::python
