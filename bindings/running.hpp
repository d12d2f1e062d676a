#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ebac/can/any_bus.hpp"
#include "ebac/can/wait.hpp"
#include "ebac/canopen/canopen_device.hpp"
#include "ebac/loop/held_back_commands.hpp"
#include "ebac/loop/observer_params.hpp"
#include "ebac/loop/retune.hpp"
#include "ebac/rt/loop_thread.hpp"
#include "ebac/rt/monotonic_clock.hpp"
#include "ebac/rt/shared_hand_target.hpp"
#include "ebac/rt/timed.hpp"
#include "ebac/sensor/optional_sensor.hpp"
#include "ebac/sensor/with_force_sensor.hpp"
#include "fields.hpp"

/// A law in a loop of real time over CANopen drives.
namespace ebac::python {

using Drives = can::CanopenDevice<can::AnyBus, can::WaitOn<can::AnyBus>>;
/// Drives, with a force sensor if there is one, and the target of the hand if it is simulated.
using Hardware = HeldBackCommands<
    rt::Timed<rt::TargetPublisher<sensor::WithForceSensor<Drives, sensor::OptionalSensor>>>>;

/// All that a run is but its bus and its law.
struct RunSetup {
  DeviceModel device;
  Environment environment;
  double dt = 1e-3;           // s
  double answer_time = 5e-4;  // s, of every tick: how long the drives may take
  can::CanopenSetup drives;
  std::optional<sensor::RdtClientSetup> sensor;
  std::shared_ptr<rt::SharedHandTarget> aim;  // of a simulated hand, where it is one
  std::optional<Limits> limits;
  std::optional<ObserverParams> observer;
  RunPlan plan;
  std::size_t rows = 0;
  bool ring = false;
  rt::Mode mode = rt::Mode::kAuto;
  rt::Options realtime;
};

/// A loop at work, which Python watches, changes and ends.
class Running {
 public:
  using All = PerAxis<AnyLaw>;

  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  Running(Running&&) = delete;
  Running& operator=(Running&&) = delete;
  virtual ~Running() = default;

  void stop(bool at_once) const { updates_->stop(at_once); }
  /// Waits up to so long [s]; returns whether it has ended.
  virtual bool wait(double seconds);
  /// Waits for its end.
  virtual void join() = 0;
  virtual bool done() const = 0;
  virtual bool at_rest() const = 0;     // once it is done
  virtual LoopState state() const = 0;  // once it is done
  virtual std::int64_t unrecorded() const = 0;
  virtual std::vector<rt::Grant> grants() const { return {}; }
  virtual can::BusCounts bus() const { return {}; }
  const std::shared_ptr<Trace>& trace() const { return trace_; }
  AppliedUpdates& changes() const { return updates_->applied(); }

  std::uint64_t retune(const AnyLaw& next);
  /// Another law, whose force is blended in.
  std::uint64_t replace(const AnyLaw& next);
  template <class Value>
  std::uint64_t post(const Value& value) {
    const std::scoped_lock one_writer(writers_);
    return updates_->post(value);
  }
  /// Another virtual world, without memory. It is kept until the end of the run: the loop never frees one.
  std::uint64_t post(const Environment& world) {
    const std::scoped_lock one_writer(writers_);
    return updates_->post(worlds_.emplace_back(fresh(world)));
  }

 protected:
  explicit Running(const AnyLaw& law)
      : updates_(std::make_shared<ParameterUpdates<All>>(law)), newest_(law) {}

  std::shared_ptr<ParameterUpdates<All>> updates_;
  std::shared_ptr<Trace> trace_;

 private:
  AnyLaw newest_;
  std::mutex writers_;
  std::vector<Environment> worlds_;
};

/// A loop in real time in its thread, over its bus. Its end stops the loop and waits for it.
class RealTimeRun final : public Running {
 public:
  using Work = Loop<Hardware, rt::MonotonicClock, All>;
  using Thread = rt::LoopThread<Hardware, rt::MonotonicClock, All>;

  /// Starts; throws what `rt::Thread` and the parts of the loop throw.
  RealTimeRun(can::AnyBus bus, const AnyLaw& law, const RunSetup& setup);

  /// Waits for the end of the loop, then stops the stream of the sensor, once; from any thread, and from several.
  void join() override;
  bool done() const override { return thread_->done(); }
  bool at_rest() const override { return thread_->loop().device().at_rest(); }
  LoopState state() const override { return thread_->loop().state(); }
  std::int64_t unrecorded() const override { return thread_->unrecorded(); }
  std::vector<rt::Grant> grants() const override { return thread_->report().grants; }
  can::BusCounts bus() const override { return bus_.counts(); }

 private:
  Hardware hardware(const RunSetup& setup);

  can::AnyBus bus_;
  std::mutex joining_;
  bool stopped_ = false;            // the stream of the sensor
  std::unique_ptr<Thread> thread_;  // last: it stops before the others go
};

/// Takes the bus: an end of a bus in this process, or a CAN interface.
can::AnyBus take_bus(const py::object& bus);

}  // namespace ebac::python
