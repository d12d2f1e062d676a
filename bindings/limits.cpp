#include "ebac/model/limits.hpp"

#include <pybind11/stl.h>

#include <optional>

#include "bind.hpp"
#include "ebac/sim/setup.hpp"
#include "fields.hpp"

namespace ebac::python {

void bind_limits(py::module_& m) {
  auto cls = bind_fields<Limits>(m, "Limits", "What a loop allows on every axis.");
  cls.def_static("of", &Limits::of, py::arg("device"),
                 "What the motor, the drive and the lever of a device can take.");
  m.def("_check_limits", &check_limits, py::arg("limits"));
  m.def(
      "_with_loop",
      [](Setup setup, double soft_start, const std::optional<Limits>& limits) {
        setup.loop.plan.soft_start = soft_start;
        check(setup.loop.plan, "simulate");
        if (limits) setup.loop.gate = Gate(*limits, setup.device, setup.timing.dt);
        return setup;
      },
      py::arg("setup"), py::kw_only(), py::arg("soft_start"), py::arg("limits"),
      "The same run, with a soft start [s] and limits.");
}

}  // namespace ebac::python
