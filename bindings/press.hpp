#pragma once

#include <vector>

#include "ebac/sim/press.hpp"
#include "sweep.hpp"

/// Presses on a wall, from which the gains of eq. (2) are chosen: the static method `_press`.
namespace ebac::python {

/// A law with the force loop of eq. (2).
template <class Law>
concept HasForceLoop = requires(Law::Params params) {
  params.kp;
  params.kd;
};

template <Controller Law>
void bind_press(py::class_<Law>& cls) {
  cls.def_static(
      "_press",
      [](const std::vector<const Setup*>& setups, const std::vector<const Law*>& laws,
         const std::vector<double>& goals, int threads, const RunLimits& limits,
         SweepProgress& progress) {
        require_all(setups, "setups");
        require_all(laws, "laws");
        if (setups.size() != laws.size() || setups.size() != goals.size()) {
          throw std::invalid_argument("setups, laws and goals: give one of each for every run");
        }
        std::vector<Press> rows;
        {
          const py::gil_scoped_release release;
          rows = press(setups, laws, goals, threads, limits, progress);
        }
        std::vector<Outcome> outcomes;
        outcomes.reserve(rows.size());
        for (const Press& row : rows) outcomes.push_back(row.outcome);
        Values columns = columns_of(outcomes);
        add_columns<PressEffort>(columns, rows,
                                 [](const Press& p) -> const PressEffort& { return p.effort; });
        return columns;
      },
      py::arg("setups"), py::arg("laws"), py::arg("goals"), py::arg("threads"), py::arg("limits"),
      py::arg("progress"));
}

}  // namespace ebac::python
