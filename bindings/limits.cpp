#include "ebac/model/limits.hpp"

#include <pybind11/stl.h>

#include <optional>

#include "bind.hpp"
#include "ebac/sim/setup.hpp"
#include "fields.hpp"

namespace ebac::python {

void bind_limits(py::module_& m) {
  auto cls = bind_fields<Limits>(m, "Limits", "Safety limits of a loop on every axis.");
  cls.def_static("of", &Limits::of, py::arg("device"),
                 "Return the limits that follow from motor, drive and stops of a device.");
  m.def("_check_limits", &check_limits, py::arg("limits"));
  m.def(
      "_with_loop",
      [](Setup setup, double soft_start, double ramp_down, const std::optional<Limits>& limits) {
        RunPlan& plan = setup.loop.plan;
        plan.soft_start = soft_start;
        plan.ramp_down = ramp_down;
        if (ramp_down > 0) plan.ticks = tick_count(setup);
        check(setup.loop.plan, "simulate");
        if (limits) setup.loop.limiter = SafetyLimiter(*limits, setup.device, setup.timing.dt);
        return setup;
      },
      py::arg("setup"), py::kw_only(), py::arg("soft_start"), py::arg("ramp_down"),
      py::arg("limits"),
      "Return the same setup with a soft start [s], a ramp to zero force after its seconds [s], "
      "and safety limits.");
}

}  // namespace ebac::python
