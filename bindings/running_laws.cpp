#include <pybind11/stl.h>

#include <utility>

#include "ebac/loop/retune.hpp"
#include "law_class.hpp"
#include "others_run.hpp"
#include "running.hpp"
#include "stepped_run.hpp"

namespace ebac::python {

RealTimeRun::RealTimeRun(can::AnyBus bus, const AnyLaw& law, const RunSetup& setup)
    : Running(law), bus_(std::move(bus)) {
  LoopOptions options{.plan = setup.plan};
  if (setup.limits) options.limiter = SafetyLimiter(*setup.limits, setup.device, setup.dt);
  All laws(law);
  const SignalChain chain(setup.device, setup.environment, laws.timing(),
                          observing(setup.observer, laws));
  auto loop = std::make_unique<Work>(hardware(setup), rt::MonotonicClock(setup.dt), std::move(laws),
                                     chain, setup.device.axes(), options);
  trace_ = loop->make_trace(setup.rows, setup.ring);
  thread_ = std::make_unique<Thread>(std::move(loop), trace_, updates_, setup.mode, setup.realtime);
}

Hardware RealTimeRun::hardware(const RunSetup& setup) {
  const std::chrono::duration<double> budget(setup.answer_time);
  Drives drives(bus_, {bus_, std::chrono::duration_cast<std::chrono::nanoseconds>(budget)},
                setup.drives);
  sensor::OptionalSensor sensor;
  if (setup.sensor) {
    sensor::RdtClient client(*setup.sensor);
    client.start();
    sensor = sensor::OptionalSensor(std::move(client));
  }
  return Hardware(rt::Timed(
      rt::TargetPublisher(sensor::WithForceSensor(drives, std::move(sensor)), setup.aim)));
}

void RealTimeRun::join() {
  const std::scoped_lock one_by_one(joining_);
  thread_->join();
  if (std::exchange(stopped_, true)) return;
  auto& sensor = thread_->loop().device().device().device().device().sensor();
  if (sensor.client() != nullptr) sensor.client()->stop();
}

std::uint64_t Running::retune(const AnyLaw& next) {
  const std::scoped_lock one_writer(writers_);
  check_retune(newest_, next);
  newest_ = next;
  return updates_->post(next);
}

std::uint64_t Running::replace(const AnyLaw& next) {
  const std::scoped_lock one_writer(writers_);
  newest_ = next;
  return updates_->post(next);
}

void add_start(const LawClass& law) {
  law.def(
      "_start",
      [](const AnyLaw& any, const py::object& bus, const RunSetup& setup) {
        return std::shared_ptr<Running>(new RealTimeRun(take_bus(bus), any, setup), WithoutLock());
      },
      "(self: LAW, bus: object, setup: ebac._core.RunSetup) -> ebac._core.Running", "",
      py::arg("bus"), py::arg("setup"));
  law.def(
      "_stepped",
      [](const AnyLaw& any, const Setup& setup, const std::optional<can::TimedBus>& bus,
         std::size_t rows) { return std::make_shared<SteppedRun>(any, setup, bus, rows); },
      "(self: LAW, setup: ebac._core.Setup, bus: ebac._core.TimedBus | None, rows: "
      "typing.SupportsInt | typing.SupportsIndex) -> ebac._core.SteppedRun",
      "", py::arg("setup"), py::arg("bus"), py::arg("rows"));
  law.def(
      "_check_retune", [](const AnyLaw& any, const AnyLaw& next) { check_retune(any, next); },
      "(self: LAW, next: LAW) -> None", "", py::arg("next"));
}

}  // namespace ebac::python
