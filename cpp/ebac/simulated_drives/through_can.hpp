#pragma once

#include <array>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "ebac/canopen/pdo_plan.hpp"
#include "ebac/loop/clock.hpp"
#include "ebac/loop/loop.hpp"
#include "ebac/simulated_drives/can_test_bench.hpp"

/// A simulated run whose currents and counts go over a CAN bus, through simulated drives. It gives
/// the bits of one without, where the torque is in whole thousandths and the delay is one tick.
namespace ebac::can {

/// A plant behind a bus as one device of the loop. The drives add one tick of delay; `delay` ticks
/// in all are kept by holding the commands back.
template <Device D>
class ThroughCan {
 public:
  ThroughCan(D plant, const DeviceModel& device, int delay)
      : bench_(std::make_unique<CanTestBench<D>>(std::move(plant), device)),
        held_(static_cast<std::size_t>(delay - 1)) {}

  Reading exchange(const Command& command) EBAC_RT {
    Reading reading = bench_->can().exchange(hold(command));
    bench_->add_sensor(reading);
    return reading;
  }
  void stop() EBAC_RT { bench_->can().stop(); }

  auto parts() const EBAC_RT { return std::tie(bench_->plant(), std::as_const(*bench_).can()); }
  CanTestBench<D>& bench() EBAC_RT { return *bench_; }

  /// Enables the drives before the first tick, without time passing. Throws std::runtime_error
  /// with their fault when they do not come up.
  void enable() {
    bench_->can().enable();
    settle([this] { return bench_->can().running(); });
    if (!bench_->can().running()) fail("reach operation enabled");
  }
  /// Disables them after the last one. A drive that is in its fault state is off already.
  void disable() {
    bench_->can().disable();
    settle([this] { return bench_->can().at_rest(); });
    if (!bench_->can().at_rest()) fail("switch off");
  }

 private:
  static constexpr int kMostSteps = 20;

  template <class Done>
  void settle(Done done) {
    for (int i = 0; i < kMostSteps && !done(); ++i) static_cast<void>(exchange({}));
  }
  [[noreturn]] void fail(const char* what) const {
    throw std::runtime_error(
        std::string("the simulated drives did not ") + what + "; fault " +
        std::to_string(static_cast<unsigned>(std::as_const(*bench_).can().fault())));
  }

  /// The command of `held_` exchanges ago; while no time passes, nothing moves on.
  Command hold(Command command) EBAC_RT {
    if (held_ == 0 || command.elapsed == 0) return command;
    std::swap(command.current, queue_[head_]);
    if (++head_ >= held_) head_ = 0;
    return command;
  }

  std::unique_ptr<CanTestBench<D>> bench_;
  std::size_t held_;
  std::array<std::array<double, kMaxAxes>, 8> queue_{};  // A, oldest at head_
  std::size_t head_ = 0;
};

/// Throws std::invalid_argument, with the remedy, for a timing that no such bus can keep.
inline void check_through_can(int axes, const Timing& timing) {
  if (timing.delay < 1) {
    throw std::invalid_argument(
        "Timing.delay = 0 samples: over a CAN bus a command acts one tick later at the earliest; "
        "must lie in [1, 8] samples");
  }
  std::vector<int> nodes;
  for (int i = 1; i <= axes; ++i) nodes.push_back(i);
  static_cast<void>(check_load({.frames = pdo_plan(nodes), .period = timing.dt}));
}

/// The device of a run: `Plant` is made from the setup, with torque in whole thousandths and the
/// delay left to the bus.
template <Device Plant, class Setup>
ThroughCan<Plant> device_through_can(const Setup& setup) {
  check_through_can(setup.device.axes(), setup.timing);
  Setup behind = setup;
  behind.timing.delay = 0;
  behind.device.drive.permille = true;
  return ThroughCan<Plant>(Plant(behind), setup.device, setup.timing.delay);
}

/// Runs `setup` under `law` to its end through a bus and returns every row: `rows` of them, or
/// fewer after a fault. The drives are enabled before the first tick and disabled after the last.
template <Device Plant, class Setup, AxesController Law>
std::shared_ptr<Trace> simulate_through_can(const Setup& setup, Law law, std::size_t rows) {
  auto device = device_through_can<Plant>(setup);
  device.enable();
  const SignalChain chain(setup.device, setup.environment, observing(setup.observer, law));
  Loop loop(std::move(device), VirtualClock(setup.timing.dt, setup.jitter, setup.seed),
            std::move(law), chain, setup.device.axes(), setup.loop);
  auto trace = loop.make_trace(rows);
  loop.run(*trace);
  loop.device().disable();
  return trace;
}

}  // namespace ebac::can
