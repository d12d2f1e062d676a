#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ebac/can/canopen_device.hpp"
#include "ebac/can/either_bus.hpp"
#include "ebac/can/wait_on.hpp"
#include "ebac/loop/retune.hpp"
#include "ebac/rt/aimed.hpp"
#include "ebac/rt/loop_thread.hpp"
#include "ebac/rt/monotonic_clock.hpp"
#include "ebac/rt/timed.hpp"
#include "ebac/sensor/optional_sensor.hpp"
#include "ebac/sensor/with_force_sensor.hpp"
#include "fields.hpp"

/// A law in a loop of real time over CANopen drives: the method `_start` of every law.
namespace ebac::python {

using Drives = can::CanopenDevice<can::EitherBus, can::WaitOn<can::EitherBus>>;
/// Drives, and a force sensor beside them where there is one; the hand is told where to go, where it
/// is a simulated one.
using Hardware = rt::Timed<rt::Aiming<sensor::WithForceSensor<Drives, sensor::OptionalSensor>>>;

/// All that a run is but its bus and its law.
struct RunSetup {
  DeviceModel device;
  Environment environment;
  double dt = 1e-3;           // s
  double answer_time = 5e-4;  // s, of every tick: how long the drives may take
  can::CanopenSetup drives;
  std::optional<sensor::RdtClientSetup> sensor;
  std::shared_ptr<rt::AimCell> aim;  // of a simulated hand, where it is one
  std::optional<Limits> limits;
  RunPlan plan;
  std::size_t rows = 0;
  bool ring = false;
  rt::Mode mode = rt::Mode::kAuto;
  rt::Options realtime;
};

/// A loop at work in its thread, whichever law it runs. Its end stops the loop and waits for it.
struct Running {
  std::shared_ptr<Trace> trace;
  std::function<void()> stop;
  std::function<void()> join;
  std::function<bool()> done;
  std::function<bool()> at_rest;     // once it is done
  std::function<LoopState()> state;  // once it is done
  std::function<std::int64_t()> unrecorded;
  std::function<std::uint64_t(const py::object&)> retune;
  std::function<std::uint64_t(const Environment&)> change_world;
  std::function<std::uint64_t(const Aim&)> aim;
  std::function<const Changes&()> changes;
  std::function<can::BusCounts()> bus;
  std::vector<rt::Grant> grants;
};

/// The bus, and the loop over it; the loop goes first.
template <Controller Law>
class HardwareLoop {
 public:
  using All = PerAxis<Law>;
  using Work = Loop<Hardware, rt::MonotonicClock, All>;
  using Thread = rt::LoopThread<Hardware, rt::MonotonicClock, All>;

  HardwareLoop(can::EitherBus bus, const Law& law, const RunSetup& setup)
      : bus_(std::move(bus)), newest_(law), mail_(std::make_shared<Mail<All>>(law)) {
    auto loop = std::make_unique<Work>(hardware(setup), rt::MonotonicClock(setup.dt), All(law),
                                       Rig(setup.device, setup.environment), setup.device.axes(),
                                       options(setup));
    trace_ = loop->make_trace(setup.rows, setup.ring);
    thread_ = std::make_unique<Thread>(std::move(loop), trace_, mail_, setup.mode, setup.realtime);
  }

  Thread& thread() { return *thread_; }
  /// Once it is done: nobody needs the sensor's stream any more.
  void join() {
    thread_->join();
    auto& sensor = thread_->loop().device().device().device().sensor();
    if (sensor.client() != nullptr) sensor.client()->stop();
  }
  const std::shared_ptr<Trace>& trace() const { return trace_; }
  const Mail<All>& mail() const { return *mail_; }
  can::BusCounts bus() const { return bus_.counts(); }

  std::uint64_t retune(const Law& next) {
    const std::scoped_lock one_writer(writers_);
    check_retune(newest_, next);
    newest_ = next;
    return mail_->post(next);
  }
  std::uint64_t change_world(const Environment& world) {
    const std::scoped_lock one_writer(writers_);
    return mail_->post(world);
  }
  std::uint64_t aim(const Aim& aim) {
    const std::scoped_lock one_writer(writers_);
    return mail_->post(aim);
  }

 private:
  Hardware hardware(const RunSetup& setup) {
    const std::chrono::duration<double> budget(setup.answer_time);
    Drives drives(bus_, {bus_, std::chrono::duration_cast<std::chrono::nanoseconds>(budget)},
                  setup.drives);
    sensor::OptionalSensor sensor;
    if (setup.sensor) {
      sensor::RdtClient client(*setup.sensor);
      client.start();
      sensor = sensor::OptionalSensor(std::move(client));
    }
    return Hardware(rt::Aiming(sensor::WithForceSensor(drives, std::move(sensor)), setup.aim));
  }
  static LoopOptions options(const RunSetup& setup) {
    LoopOptions options{.plan = setup.plan};
    if (setup.limits) options.gate = Gate(*setup.limits, setup.device, setup.dt);
    return options;
  }

  can::EitherBus bus_;
  Law newest_;
  std::mutex writers_;
  std::shared_ptr<Mail<All>> mail_;
  std::shared_ptr<Trace> trace_;
  std::unique_ptr<Thread> thread_;  // last: it stops before the others go
};

/// Starts; throws what `rt::Thread` and the parts of the loop throw.
template <Controller Law>
Running start_running(can::EitherBus bus, const Law& law, const RunSetup& setup) {
  auto work = std::make_shared<HardwareLoop<Law>>(std::move(bus), law, setup);
  return {.trace = work->trace(),
          .stop = [work] { work->thread().stop(); },
          .join = [work] { work->join(); },
          .done = [work] { return work->thread().done(); },
          .at_rest = [work] { return work->thread().loop().device().at_rest(); },
          .state = [work] { return work->thread().loop().state(); },
          .unrecorded = [work] { return work->thread().unrecorded(); },
          .retune = [work](const py::object& next) { return work->retune(next.cast<Law>()); },
          .change_world = [work](const Environment& w) { return work->change_world(w); },
          .aim = [work](const Aim& aim) { return work->aim(aim); },
          .changes = [work]() -> const Changes& { return work->mail().changes(); },
          .bus = [work] { return work->bus(); },
          .grants = work->thread().report().grants};
}

/// Takes the bus: an end of a bus in this process, or a CAN interface.
can::EitherBus take_bus(const py::object& bus);

/// The method `_start` of a law that is bound already.
template <Controller Law>
void bind_start_of() {
  auto cls = py::reinterpret_borrow<py::class_<Law>>(py::type::of<Law>());
  cls.def(
      "_start",
      [](const Law& law, const py::object& bus, const RunSetup& setup) {
        return start_running(take_bus(bus), law, setup);
      },
      py::arg("bus"), py::arg("setup"));
  cls.def(
      "_check_retune", [](const Law& law, const Law& next) { check_retune(law, next); },
      py::arg("next"));
}

}  // namespace ebac::python
