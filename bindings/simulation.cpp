#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bind.hpp"
#include "ebac/loop/trace.hpp"
#include "ebac/sim/setup.hpp"
#include "ebac/sim/simulated_device.hpp"
#include "fields.hpp"
#include "others_run.hpp"
#include "python_hand.hpp"

namespace ebac::python {

namespace {

using Bytes = py::array_t<std::uint8_t, py::array::c_style>;

/// Copies rows `start` to `stop`, less those a ring has written over.
std::pair<std::size_t, Bytes> copy_of(const Trace& trace, std::size_t start, std::size_t stop) {
  if (start > stop || stop > trace.size()) {
    throw py::index_error("rows " + std::to_string(start) + " to " + std::to_string(stop) +
                          ": the trace has had " + std::to_string(trace.size()));
  }
  const std::size_t from = std::clamp(trace.first(), start, stop);
  std::vector<std::byte> copied((stop - from) * trace.row_bytes());
  std::size_t lost = 0;
  {
    const OthersRun release;
    lost = trace.copy(from, copied);
  }
  const std::size_t gone = lost * trace.row_bytes();
  Bytes rows(static_cast<py::ssize_t>(copied.size() - gone));
  if (rows.size() > 0) std::memcpy(rows.mutable_data(), copied.data() + gone, copied.size() - gone);
  return {from + lost, rows};
}

Bytes bytes_of(const std::shared_ptr<Trace>& trace) {
  if (trace->ring()) {
    Bytes rows = copy_of(*trace, trace->first(), trace->size()).second;
    rows.attr("setflags")(py::arg("write") = false);
    return rows;
  }
  Bytes view(static_cast<py::ssize_t>(trace->size() * trace->row_bytes()),
             reinterpret_cast<const std::uint8_t*>(trace->data()), py::cast(trace));
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

std::shared_ptr<Trace> empty_like(const Trace& trace, std::size_t capacity, bool ring) {
  if (capacity < 1)
    throw std::invalid_argument("Rows.empty_like: capacity = 0 rows: must be at least 1");
  return std::make_shared<Trace>(trace, capacity, ring);
}

void append_row(Trace& trace, const Bytes& row) {
  if (static_cast<std::size_t>(row.size()) != trace.row_bytes()) {
    throw std::invalid_argument("Rows.append: " + std::to_string(row.size()) +
                                " bytes: a row has " + std::to_string(trace.row_bytes()));
  }
  std::byte* next = trace.next();
  if (next == nullptr) {
    throw py::index_error("Rows.append: the trace is full with " + std::to_string(trace.size()) +
                          " rows");
  }
  std::memcpy(next, row.data(), trace.row_bytes());
  trace.commit();
}

/// How the rows of a trace are laid out, without the rows: what Python makes of it is kept for the
/// next run of the same layout.
struct Layout {
  std::vector<Column> columns;
  std::size_t row_bytes;
  int axes;

  bool operator==(const Layout&) const = default;

  std::size_t hash() const {
    std::size_t all = row_bytes + static_cast<std::size_t>(axes);
    for (const Column& c : columns) all = all * 31 + std::hash<std::string>{}(c.name) + c.offset;
    return all;
  }
};

Layout layout_of(const Trace& trace) { return {trace.columns(), trace.row_bytes(), trace.axes()}; }

void bind_trace(py::module_& m) {
  py::class_<Column>(m, "Column", "Position of a named quantity in a row.")
      .def_readonly("name", &Column::name, "Name.")
      .def_readonly("unit", &Column::unit, "SI unit; '1' for a pure number.")
      .def_readonly("meaning", &Column::meaning, "Meaning.")
      .def_readonly("kind", &Column::kind, "f double, i int64, w int32, u uint32, b bool.")
      .def_readonly("offset", &Column::offset, "Bytes from the start of the row to the first axis.")
      .def_readonly("stride", &Column::stride, "Bytes from axis to axis; 0 for one value per row.");
  py::class_<Layout>(m, "RowLayout", "How rows are laid out; hashable, equal to that of like rows.")
      .def_readonly("columns", &Layout::columns, "Columns in their order.")
      .def_readonly("row_bytes", &Layout::row_bytes, "Bytes per row.")
      .def_readonly("axes", &Layout::axes, "Number of axes.")
      .def("__hash__", &Layout::hash)
      .def("__eq__", [](const Layout& a, const Layout& b) { return a == b; });
  py::class_<Trace, std::shared_ptr<Trace>>(m, "Rows", "The rows of a run, as written by the loop.")
      .def("__len__", [](const Trace& trace) { return trace.size() - trace.first(); })
      .def_property_readonly("count", &Trace::size, "Rows appended since the start.")
      .def_property_readonly("first", &Trace::first, "Number of the first row still in memory.")
      .def_property_readonly("capacity", &Trace::capacity, "Largest number of rows.")
      .def_property_readonly(
          "ring", &Trace::ring,
          "Whether this is a ring, which keeps the last rows and never fills up.")
      .def_property_readonly("axes", &Trace::axes, "Number of axes.")
      .def_property_readonly("row_bytes", &Trace::row_bytes, "Bytes per row.")
      .def_property_readonly("layout", &layout_of, "How the rows are laid out.")
      .def("bytes", &bytes_of,
           "Return all rows in memory, read-only; a ring returns a copy, others a view.")
      .def("copy", &copy_of, py::arg("start"), py::arg("stop"),
           "Copy the rows start to stop, without rows overwritten by a ring; return (number of the "
           "first row, rows).")
      .def("empty_like", &empty_like, py::arg("capacity"), py::arg("ring") = false,
           "Return an empty trace of the same layout.")
      .def("append", &append_row, py::arg("row"), "Append one row of `row_bytes` bytes.")
      .def(
          "port",
          [](const Trace& trace, std::size_t row, std::size_t axis) {
            if (row < trace.first() || row >= trace.size() ||
                axis >= static_cast<std::size_t>(trace.axes())) {
              throw py::index_error("row " + std::to_string(row) + ", axis " +
                                    std::to_string(axis) + ": the trace has " +
                                    std::to_string(trace.size()) + " rows and " +
                                    std::to_string(trace.axes()) + " axes");
            }
            return trace.sample(row).axis[axis].port;
          },
          py::arg("row"), py::arg("axis") = 0, "Return the port as the law saw it in a tick.");
}

void bind_setup(py::module_& m) {
  py::class_<Setup>(m, "Setup", "Setup of a simulated run, without the law.")
      .def(py::init([](const DeviceModel& device, const Hand& hand, const Environment& environment,
                       const Timing& timing, double seconds, double jitter, std::uint64_t seed,
                       const std::optional<ObserverParams>& observer) {
             Setup setup{device, for_one_run(hand), environment, timing, seconds, jitter, seed};
             setup.observer = observer;
             return setup;
           }),
           py::kw_only(), py::arg("device"), py::arg("hand"), py::arg("environment"),
           py::arg("timing"), py::arg("seconds"), py::arg("jitter"), py::arg("seed"),
           py::arg("observer") = py::none())
      .def(
          "_raise_hand_error",
          [](const Setup& setup) {
            if (const std::exception_ptr error = hand_error(setup.hand)) {
              std::rethrow_exception(error);
            }
          },
          "Raise what a hand in Python raised in the run of this setup.");
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
          "Advance by `share` of a tick from time t [s] on, under constant motor currents [A].")
      .def(
          "truth",
          [](const Plant& plant, std::size_t axis) {
            if (axis >= plant.axes()) {
              throw py::index_error("axis " + std::to_string(axis) + ": the plant has " +
                                    std::to_string(plant.axes()) + " axes");
            }
            return plant.truth(axis);
          },
          py::arg("axis") = 0, "Return the state of one axis.");
}

}  // namespace

void bind_simulation(py::module_& m) {
  bind_trace(m);
  bind_setup(m);
  bind_fields<AxisTruth>(m, "AxisTruth", "True state of an axis, known only in a simulation.");
  bind_plant<ExactPlant>(m, "ExactPlant",
                         "Independent rigid axes with a hand on each, integrated exactly.");
  bind_plant<SteppedPlant>(m, "SteppedPlant",
                           "Any device with a hand on it, integrated step by step.");
}

}  // namespace ebac::python
