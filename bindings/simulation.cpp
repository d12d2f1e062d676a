#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bind.hpp"
#include "ebac/loop/trace.hpp"
#include "ebac/sim/setup.hpp"
#include "ebac/sim/simulated_device.hpp"
#include "fields.hpp"

namespace ebac::python {

namespace {

void bind_trace(py::module_& m) {
  py::class_<Column>(m, "Column", "Where a named quantity lies in a row.")
      .def_readonly("name", &Column::name, "Name.")
      .def_readonly("unit", &Column::unit, "SI unit; '1' for a pure number.")
      .def_readonly("meaning", &Column::meaning, "What it is.")
      .def_readonly("kind", &Column::kind, "f double, i int64, w int32, u uint32, b bool.")
      .def_readonly("offset", &Column::offset, "Bytes from the start of the row to the first axis.")
      .def_readonly("stride", &Column::stride, "Bytes from axis to axis; 0 for one value per row.");
  py::class_<Trace, std::shared_ptr<Trace>>(m, "Rows", "The rows of a run, as the loop wrote them.")
      .def("__len__", &Trace::size)
      .def_property_readonly("axes", &Trace::axes, "Number of axes.")
      .def_property_readonly("row_bytes", &Trace::row_bytes, "Bytes per row.")
      .def_property_readonly("columns", &Trace::columns, "Columns in their order.")
      .def(
          "bytes",
          [](const std::shared_ptr<Trace>& trace) {
            const py::array_t<std::uint8_t> view(
                static_cast<py::ssize_t>(trace->size() * trace->row_bytes()),
                reinterpret_cast<const std::uint8_t*>(trace->data()), py::cast(trace));
            view.attr("setflags")(py::arg("write") = false);
            return view;
          },
          "Every row, read-only, without a copy.")
      .def(
          "port",
          [](const Trace& trace, std::size_t row, std::size_t axis) {
            if (row >= trace.size() || axis >= static_cast<std::size_t>(trace.axes())) {
              throw py::index_error("row " + std::to_string(row) + ", axis " +
                                    std::to_string(axis) + ": the trace has " +
                                    std::to_string(trace.size()) + " rows and " +
                                    std::to_string(trace.axes()) + " axes");
            }
            return trace.sample(row).axis[axis].port;
          },
          py::arg("row"), py::arg("axis") = 0, "What the law saw in a tick.");
}

void bind_setup(py::module_& m) {
  py::class_<Setup>(m, "Setup", "Everything of a simulated run but the law.")
      .def(py::init([](const DeviceModel& device, const Hand& hand, const Environment& environment,
                       const Timing& timing, double seconds, double jitter, std::uint64_t seed) {
             return Setup{device, hand, environment, timing, seconds, jitter, seed};
           }),
           py::kw_only(), py::arg("device"), py::arg("hand"), py::arg("environment"),
           py::arg("timing"), py::arg("seconds"), py::arg("jitter"), py::arg("seed"));
}

/// A plant alone, stepped from Python: for tests against other integrators.
template <class Plant>
void bind_plant(py::module_& m, const char* name, const char* doc) {
  py::class_<Plant>(m, name, doc)
      .def(py::init([](const DeviceModel& device, const Hand& hand, double tick) {
             check(Timing{.dt = tick}, "Timing");
             return Plant(device, hand, tick);
           }),
           py::kw_only(), py::arg("device"), py::arg("hand"), py::arg("tick"))
      .def(
          "advance",
          [](Plant& plant, const std::vector<double>& current, double t, double share) {
            const bool fits = current.size() <= static_cast<std::size_t>(kMaxAxes);
            if (!fits || !(share > 0) || share > 100) {
              throw std::invalid_argument(
                  "advance: current has at most 3 values, share lies in (0, 100]");
            }
            Axes amperes = Axes::Zero();
            for (std::size_t i = 0; i < current.size(); ++i)
              amperes[static_cast<Eigen::Index>(i)] = current[i];
            plant.advance(amperes, t, std::llround(share * static_cast<double>(kQuanta)));
          },
          py::arg("current"), py::arg("t"), py::arg("share") = 1.0,
          "Moves by `share` of a tick from time t [s] on, under constant motor currents [A].")
      .def(
          "truth",
          [](const Plant& plant, std::size_t axis) {
            if (axis >= plant.axes()) {
              throw py::index_error("axis " + std::to_string(axis) + ": the plant has " +
                                    std::to_string(plant.axes()) + " axes");
            }
            return plant.truth(axis);
          },
          py::arg("axis") = 0, "The state of one axis.");
}

}  // namespace

void bind_simulation(py::module_& m) {
  bind_trace(m);
  bind_setup(m);
  bind_fields<AxisTruth>(m, "AxisTruth", "What only a simulation can know about an axis.");
  bind_plant<ExactPlant>(m, "ExactPlant",
                         "Independent rigid axes with a hand on each, integrated exactly.");
  bind_plant<SteppedPlant>(m, "SteppedPlant",
                           "Any device with a hand on it, integrated step by step.");
}

}  // namespace ebac::python
