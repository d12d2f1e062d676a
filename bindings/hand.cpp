#include "ebac/model/hand.hpp"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bind.hpp"
#include "fields.hpp"
#include "python_hand.hpp"

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

void bind_models(py::module_& m) {
  bind_fields<Reflex>(
      m, "Reflex",
      "A hand with a stretch reflex: muscle force that answers the motion of `delay` ago.\n\n"
      "F = K0 (X0 - x) - B0 v - M0 a + r; the reflex r is `stretch_gain` K0 (X0 - x) - "
      "`velocity_gain` B0 v,\nof `delay` ago, through the activation of the muscle, a low-pass of "
      "second order. Model of "
      "van der Helm\net al. 2002 (J. Neurosci. Methods 119); activation of Mugge et al. 2010 "
      "(PMC5664365, table 1); delay and gains are from memory of the first.");
  bind_fields<FingerPad>(
      m, "FingerPad",
      "A hand behind the pulp of its fingers: an exponential spring that relaxes, in series.\n\n"
      "F_e = `stiffness`/`rise` (exp(`rise` d) - 1) at a compression d, straight from `stiffest` "
      "on; shares of it relax\nwithin 4 ms, 70 ms and 1.4 s. Form and times of Pawluk and Howe "
      "1999 "
      "(J. Biomech. Eng. 121, 178), up to 2 N;\nnumbers from memory of it, beyond 2 N assumed.");
  bind_fields<NonlinearGrip>(
      m, "NonlinearGrip",
      "A hand that stiffens with its force: K = K0 (1 + |F| / `force`), B = B0 sqrt(K / K0).\n\n"
      "Stiffness linear in force: Van Doren 1998 (Motor Control 2, 352), Hoeppner et al. 2013 "
      "(PLOS "
      "ONE 8, e80889); damping\nthat rises too: Hasser and Cutkosky 2002, Hajian and Howe 1997. "
      "The "
      "numbers are indicative.");
  bind_fields<LetGo>(
      m, "LetGo",
      "A hand that lets go of the handle and grips it again.\n\n"
      "Its mass, damper and spring stand behind a grip of `stiffness` and `damping` that opens at "
      "`open_at` and closes at\n`closed_at`; an open hand follows the handle. Stiffness and "
      "damping "
      "are indicative (several fingers of Hajian and\nHowe 1997).");
}

void bind_hand(py::module_& m) {
  py::class_<Hand> cls(m, "Hand",
                       ("The operator of eq. (4), (5): mass, damper and spring pulled along an "
                        "intended path.\n\n`path` is one path, for the first axis, or one for each "
                        "axis; the others stay at 0. `target` [m] is short for a `Step` to that "
                        "place, or one for each axis; give one of the two.\n`model` makes "
                        "another force of these than eq. (4), see `ebac.hands`." +
                        parameter_table(field_table<Hand>()))
                           .c_str());
  def_init(
      cls,
      [](const py::args& args, const py::kwargs& given) {
        const FieldTable& table = field_table<Hand>();
        auto known = field_names(table);
        known.emplace_back("path");
        known.emplace_back("target");
        known.emplace_back("model");
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
                                   ": must be a number in m, or one for each axis; a path, such as "
                                   "MinimumJerk, is given as path=");
            }
          } else if (word == "model") {
            hand.model = hand_model(py::reinterpret_borrow<py::object>(item));
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
        if (!std::holds_alternative<OwnHand>(hand.model)) hand_force(hand, 0);  // refuses a misfit
        return hand;
      },
      "__init__(self, *" + signature(field_table<Hand>()) +
          ", path: Step | MinimumJerk | Sine | Tapping | Recorded | typing.Sequence[Step | "
          "MinimumJerk | Sine | Tapping | Recorded] = ..., target: float | "
          "typing.Sequence[float] | None = None, model: typing.Any = None) -> None");
  add_members(cls, field_table<Hand>(), &place_of<Hand>);
  add_signature(
      cls, field_table<Hand>(),
      {{"path", py::tuple(py::cast(Hand{}.path))}, {"target", py::none()}, {"model", py::none()}});
  cls.def_property_readonly(
         "path",
         [](const Hand& hand) { return std::make_tuple(hand.path[0], hand.path[1], hand.path[2]); },
         "Intended path of each axis.")
      .def_property_readonly(
          "model", [](const Hand& hand) { return model_object(hand.model); },
          "What makes its force: Reflex, FingerPad, NonlinearGrip, LetGo, a hand of your own, or "
          "None for eq. (4).")
      .def(
          "steady",
          [](const Hand& hand, double x) {
            const double target = std::visit(
                [](const auto& p) { return p.position(std::numeric_limits<double>::max()); },
                hand.path[0]);
            const auto force = hand_force(hand, 0);
            return force == nullptr ? hand.stiffness * (target - x) : force->steady(target, x);
          },
          py::arg("x"),
          "Return the force [N] on the first axis at rest at x [m], at the end of its path; NaN "
          "where none is known.")
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
            if (!hand.linear()) values["model"] = model_object(hand.model);
            return values;
          },
          "Return the parameters by name.");
  add_value_methods(cls);
}

}  // namespace

void bind_hands(py::module_& m) {
  bind_paths(m);
  bind_models(m);
  bind_hand(m);
}

}  // namespace ebac::python
