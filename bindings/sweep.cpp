#include "sweep.hpp"

#include <functional>
#include <optional>
#include <tuple>
#include <vector>

#include "bind.hpp"
#include "ebac/sim/ideal_wall.hpp"
#include "others_run.hpp"

namespace ebac::python {

namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Position, applied force, force of the virtual world and pull of the hand on another axis.
using OtherAxis = std::tuple<Numbers, Numbers, Numbers, std::optional<Numbers>>;

std::span<const double> view(const std::optional<Numbers>& values) {
  if (!values) return {};
  return {values->data(), static_cast<std::size_t>(values->size())};
}

void bind_contact(py::module_& m) {
  m.attr("TAIL_SHARE") = kTailShare;
  m.attr("FEWEST_ROWS") = kFewestRows;
  m.attr("STILL_SWING") = kStillSwing;
  m.attr("QUIET_PERCEIVED") = kQuietPerceived;
  m.def(
      "_measure_contact",
      [](const Numbers& t, const Numbers& x, const Numbers& force,
         const std::optional<Numbers>& energy, const std::optional<Numbers>& stored,
         const std::optional<Numbers>& clamped, const std::optional<Numbers>& pull,
         const std::optional<Numbers>& wall, const std::vector<OtherAxis>& others) {
        const ContactRecord record{.t = view(t),
                                   .x = view(x),
                                   .force = view(force),
                                   .energy = view(energy),
                                   .stored = view(stored),
                                   .clamped = view(clamped),
                                   .pull = view(pull),
                                   .wall = view(wall)};
        WallContact c = measure_contact(record);
        const double at_rest = rest_power(record, c);
        for (const auto& [x_i, force_i, wall_i, pull_i] : others) {
          const ContactRecord other{.t = view(t),
                                    .x = view(x_i),
                                    .force = view(force_i),
                                    .pull = view(pull_i),
                                    .wall = view(wall_i)};
          if (touched_at_end(other)) c.take_worse(measure_contact(other));
        }
        Values numbers = values_of(c);
        numbers["rest_power"] = at_rest;
        numbers["still"] = c.still();
        numbers["force_quiet"] = c.force_quiet();
        numbers["quiet"] = c.quiet();
        return numbers;
      },
      py::kw_only(), py::arg("t"), py::arg("x"), py::arg("force"), py::arg("energy") = py::none(),
      py::arg("stored") = py::none(), py::arg("clamped") = py::none(), py::arg("pull") = py::none(),
      py::arg("wall") = py::none(), py::arg("others") = std::vector<OtherAxis>());
  m.def(
      "_stored_energy",
      [](const Environment& environment, const Kinematics& kinematics, const Numbers& x,
         const Numbers& t) {
        if (x.ndim() != 2 || x.shape(1) > kMaxAxes || t.ndim() != 1 || t.shape(0) != x.shape(0)) {
          throw std::invalid_argument("x: must have the shape (rows, axes), t (rows,)");
        }
        std::vector<double> stored;
        StoredEnergy energy(environment, kinematics);
        for (py::ssize_t i = 0; i < x.shape(0); ++i) {
          Axes at = Axes::Zero();
          for (py::ssize_t j = 0; j < x.shape(1); ++j) at[j] = x.at(i, j);
          stored.push_back(energy.at(at, t.at(i)));
        }
        return column<double>(stored, [](double joule) { return joule; });
      },
      py::arg("environment"), py::arg("kinematics"), py::arg("x"), py::arg("t"));
}

Values ideal_contacts(const std::vector<const Setup*>& setups, int threads,
                      SweepProgress& progress) {
  require_all(setups, "setups");
  std::vector<IdealContact> rows(setups.size());
  {
    const OthersRun release;
    for_each_run(setups.size(), threads, progress, [&](std::size_t i, ContactRecorder& recorder) {
      rows[i] = ideal_contact(*setups[i], recorder);
    });
  }
  Values columns;
  add_columns<IdealContact>(columns, rows, std::identity{});
  return columns;
}

}  // namespace

void bind_sweeps(py::module_& m) {
  bind_contact(m);
  bind_fields<RunLimits>(m, "RunLimits",
                         "Bounds beyond which a run of a sweep counts as diverged and ends.");
  py::class_<SweepProgress>(m, "SweepProgress", "Progress of a sweep in another thread.")
      .def(py::init<>())
      .def_property_readonly(
          "done", [](const SweepProgress& progress) { return progress.done.load(); }, "Runs done.")
      .def(
          "cancel", [](SweepProgress& progress) { progress.cancelled = true; },
          "Cancel the sweep within some hundred ticks; finished runs are kept.")
      .def_property_readonly(
          "cancelled", [](const SweepProgress& progress) { return progress.cancelled.load(); },
          "Whether it was cancelled.");
  m.def("_ideal_contacts", &ideal_contacts, py::arg("setups"), py::arg("threads"),
        py::arg("progress"));
}

}  // namespace ebac::python
