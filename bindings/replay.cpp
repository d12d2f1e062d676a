#include "replay.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "bind.hpp"
#include "values.hpp"

namespace ebac::python {

namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Counts = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
using Codes = py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>;

/// What a log is read from: columns of (rows), and of (rows, axes).
struct LogColumns {
  Numbers t, dt, lateness;
  Codes fault;
  Numbers force_age;
  Codes force_status;
  Numbers gain, came;
  Counts counts;
  Numbers counts_age, current_applied, force, f_env, f_cmd, current;
};

void require_shape(const py::array& column, const char* name, py::ssize_t rows, py::ssize_t axes) {
  const bool whole = axes == 0 && column.ndim() == 1 && column.shape(0) == rows;
  const bool each =
      axes > 0 && column.ndim() == 2 && column.shape(0) == rows && column.shape(1) == axes;
  if (!whole && !each) {
    throw std::invalid_argument(std::string("replay: ") + name +
                                " has another shape than t and counts");
  }
}

void require_shapes(const LogColumns& c) {
  if (c.t.ndim() != 1 || c.t.shape(0) < 1 || c.counts.ndim() != 2 || c.counts.shape(1) < 1 ||
      c.counts.shape(1) > kMaxAxes) {
    throw std::invalid_argument("replay: t must be (rows), counts (rows, axes) with 1 to 3 axes");
  }
  const py::ssize_t rows = c.t.shape(0);
  const py::ssize_t axes = c.counts.shape(1);
  require_shape(c.dt, "dt", rows, 0);
  require_shape(c.lateness, "lateness", rows, 0);
  require_shape(c.fault, "fault", rows, 0);
  require_shape(c.force_age, "force_age", rows, 0);
  require_shape(c.force_status, "force_status", rows, 0);
  require_shape(c.gain, "gain", rows, 0);
  require_shape(c.came, "came", rows, 0);
  require_shape(c.counts, "counts", rows, axes);
  require_shape(c.counts_age, "counts_age", rows, axes);
  require_shape(c.current_applied, "current_applied", rows, axes);
  require_shape(c.force, "force", rows, axes);
  require_shape(c.f_env, "f_env", rows, axes);
  require_shape(c.f_cmd, "f_cmd", rows, axes);
  require_shape(c.current, "current", rows, axes);
}

std::shared_ptr<ReplayLog> make_log(const LogColumns& c) {
  require_shapes(c);
  const auto rows = static_cast<std::size_t>(c.t.shape(0));
  auto log = std::make_shared<ReplayLog>();
  log->axes = static_cast<std::size_t>(c.counts.shape(1));
  log->row.reserve(rows);
  log->axis.reserve(rows * log->axes);
  for (std::size_t i = 0; i < rows; ++i) {
    log->row.push_back({.instant = {c.t.data()[i], c.dt.data()[i], c.lateness.data()[i]},
                        .fault = static_cast<Fault>(c.fault.data()[i]),
                        .force_age = c.force_age.data()[i],
                        .force_status = static_cast<SensorStatus>(c.force_status.data()[i]),
                        .gain = c.gain.data()[i],
                        .came = c.came.data()[i]});
  }
  for (std::size_t i = 0; i < rows * log->axes; ++i) {
    log->axis.push_back({.counts = c.counts.data()[i],
                         .counts_age = c.counts_age.data()[i],
                         .current_applied = c.current_applied.data()[i],
                         .force = c.force.data()[i],
                         .recorded = {.f_env = c.f_env.data()[i],
                                      .f_cmd = c.f_cmd.data()[i],
                                      .current = c.current.data()[i]}});
  }
  return log;
}

}  // namespace

void bind_replay(py::module_& m) {
  py::class_<ReplayLog, std::shared_ptr<ReplayLog>>(m, "ReplayLog", "A recorded log as a device.")
      .def(py::init([](const Numbers& t, const Numbers& dt, const Numbers& lateness,
                       const Codes& fault, const Numbers& force_age, const Codes& force_status,
                       const Counts& counts, const Numbers& counts_age,
                       const Numbers& current_applied, const Numbers& force, const Numbers& f_env,
                       const Numbers& f_cmd, const Numbers& current, const Numbers& gain,
                       const Numbers& came) {
             return make_log({t, dt, lateness, fault, force_age, force_status, gain, came, counts,
                              counts_age, current_applied, force, f_env, f_cmd, current});
           }),
           py::kw_only(), py::arg("t"), py::arg("dt"), py::arg("lateness"), py::arg("fault"),
           py::arg("force_age"), py::arg("force_status"), py::arg("counts"), py::arg("counts_age"),
           py::arg("current_applied"), py::arg("force"), py::arg("f_env"), py::arg("f_cmd"),
           py::arg("current"), py::arg("gain"), py::arg("came"))
      .def("__len__", &ReplayLog::rows)
      .def_readwrite("observer", &ReplayLog::observer, "Observer of the replay, or None.")
      .def_property_readonly(
          "axes", [](const ReplayLog& log) { return log.axes; }, "Number of axes.");
}

}  // namespace ebac::python
