#pragma once

#include <memory>

#include "ebac/sim/replay.hpp"
#include "fields.hpp"

/// A law driven by a recorded log: the method `_replay` of every law.
namespace ebac::python {

template <AxesController Law>
std::shared_ptr<Trace> replay_on(const std::shared_ptr<ReplayLog>& log, Law law,
                                 const DeviceModel& device, const Environment& environment) {
  if (log->axes != static_cast<std::size_t>(device.axes())) {
    throw std::invalid_argument("replay: the log has " + std::to_string(log->axes) +
                                " axes, the device " + std::to_string(device.axes()));
  }
  return replay(log, std::move(law), device, environment);
}

template <Controller Law>
void bind_replay_of(py::class_<Law>& cls) {
  cls.def(
      "_replay",
      [](const Law& law, const std::shared_ptr<ReplayLog>& log, const DeviceModel& device,
         const Environment& environment) {
        const py::gil_scoped_release release;
        return replay_on(log, PerAxis<Law>(law), device, environment);
      },
      py::arg("log"), py::arg("device"), py::arg("environment"));
}

}  // namespace ebac::python
