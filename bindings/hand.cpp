#include "ebac/model/hand.hpp"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bind.hpp"
#include "fields.hpp"

namespace ebac::python {

namespace {

void bind_paths(py::module_& m) {
  bind_fields<Step>(m, "Step", "A step: moves to `target` at time `at`.");
  bind_fields<MinimumJerk>(m, "MinimumJerk",
                           "A minimum-jerk motion to `target` (Flash and Hogan 1985).");
  bind_fields<Sine>(m, "Sine", "A sine around a centre.");
  bind_fields<Tapping>(m, "Tapping", "Square tapping: half a period at `target`, half at `rest`.");
  py::class_<Recorded> recorded(m, "Recorded",
                                "A path from a log: straight between its points, constant beyond.");
  def_init(
      recorded,
      [](const py::args& args, const py::kwargs& keywords) {
        const std::vector<std::string> known{"t", "x"};
        refuse_positional("Recorded", args, known);
        std::vector<double> t;
        std::vector<double> x;
        py::dict given(keywords);
        for (const std::string& name : known) {
          if (given.contains(name)) continue;
          throw py::type_error("Recorded: '" + name + "' is missing; it needs t [s] and x [m]");
        }
        take_part(given, "Recorded", "t", t, "a sequence of numbers, in s");
        take_part(given, "Recorded", "x", x, "a sequence of numbers, in m");
        refuse_rest("Recorded", given, known);
        return Recorded(std::move(t), std::move(x));
      },
      "__init__(self: ebac._core.Recorded, *, t: collections.abc.Sequence[typing.SupportsFloat | "
      "typing.SupportsIndex], "
      "x: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]) -> None\n\n"
      "Times [s], strictly rising, and positions [m], as many.\n");
  recorded.def_property_readonly("t", &Recorded::t, "Times [s].")
      .def_property_readonly("x", &Recorded::x, "Positions [m].")
      .def(
          "as_dict",
          [](const Recorded& r) -> Values {
            using namespace py::literals;
            return py::dict("t"_a = r.t(), "x"_a = r.x());
          },
          "Return the parameters by name.");
  add_value_methods(recorded);
  const py::object none = py::module_::import("inspect").attr("Parameter").attr("empty");
  add_signature(recorded, FieldTable{}, {{"t", none}, {"x", none}});
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

using Targets = std::variant<double, std::vector<double>>;

/// Steps at once to these places: of the first axis, or of each.
Paths steps_to(const Targets& targets) {
  const auto step = [](double target) -> Path {
    const Step to{.target = target};
    check(to, "Hand");
    return to;
  };
  if (const auto* one = std::get_if<double>(&targets)) return step(*one);
  std::vector<Path> steps;
  for (const double target : std::get<std::vector<double>>(targets)) steps.push_back(step(target));
  return steps;
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
                        "axis; the others stay at 0. `target` [m] is short for a `Step` to that "
                        "place, or one for each axis; give one of the two." +
                        parameter_table(field_table<Hand>()))
                           .c_str());
  def_init(
      cls,
      [](const py::args& args, const py::kwargs& given) {
        const FieldTable& table = field_table<Hand>();
        auto known = field_names(table);
        known.emplace_back("path");
        known.emplace_back("target");
        refuse_positional("Hand", args, known);
        Hand hand;
        const auto is_given = [&](const char* name) {
          return given.contains(name) && !given[name].is_none();
        };
        if (is_given("path") && is_given("target")) {
          throw py::type_error(
              "Hand: path and target are both given; target is short for path=Step(target=...)");
        }
        for (const auto& [key, item] : given) {
          const auto word = py::cast<std::string>(key);
          if (word == "target") {
            if (item.is_none()) continue;
            try {
              set_paths(hand, steps_to(item.cast<Targets>()));
            } catch (const py::cast_error&) {
              throw py::type_error("Hand.target = " + py::cast<std::string>(py::repr(item)) +
                                   ": must be a number in m, or one for each axis");
            }
          } else if (word == "path") {
            try {
              set_paths(hand, item.cast<Paths>());
            } catch (const py::cast_error&) {
              throw py::type_error(
                  "Hand.path = " + py::cast<std::string>(py::repr(item)) +
                  ": must be Step, MinimumJerk, Sine, Tapping, Recorded, or a list of them");
            }
          } else if (!set_field(table, &hand, "Hand", word, item)) {
            refuse_keyword("Hand", word, known);
          }
        }
        check(hand, "Hand");
        return hand;
      },
      "__init__(self, *" + signature(field_table<Hand>()) +
          ", path: Step | MinimumJerk | Sine | Tapping | Recorded | typing.Sequence[Step | "
          "MinimumJerk | Sine | Tapping | Recorded] = ..., target: float | "
          "typing.Sequence[float] | None = None) -> None");
  add_members(cls, field_table<Hand>(), &place_of<Hand>);
  add_signature(cls, field_table<Hand>(),
                {{"path", py::tuple(py::cast(Hand{}.path))}, {"target", py::none()}});
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
          py::arg("t"), py::arg("axis") = 0, "Return X0(t) [m], tremor included, at time t [s].")
      .def(
          "pull",
          [](const Hand& hand, const Numbers& t, const Numbers& x, int axis) {
            require_axis(axis);
            return py::vectorize([&hand, axis](double at, double where) {
              return hand.pull(axis, at, where);
            })(t, x);
          },
          py::arg("t"), py::arg("x"), py::arg("axis") = 0,
          "Return the pulling force |K0 (X0(t) - x)| [N] at times t [s] and positions x [m].")
      .def(
          "as_dict",
          [](const Hand& hand) {
            Values values = values_of(hand);
            values["path"] = py::tuple(py::cast(hand.path));
            return values;
          },
          "Return the parameters by name.");
  add_value_methods(cls);
}

}  // namespace

void bind_hands(py::module_& m) {
  bind_paths(m);
  bind_hand(m);
}

}  // namespace ebac::python
