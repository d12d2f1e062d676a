#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "ebac/canopen/pdo_plan.hpp"
#include "ebac/loop/loop.hpp"
#include "ebac/loop/virtual_clock.hpp"
#include "ebac/simulated_drives/can_test_bench.hpp"

/// A simulated run whose currents and counts go over a CAN bus, through simulated drives. It gives
/// the bits of one without, where the torque is in whole thousandths and the delay is one tick.
namespace ebac::can {

/// The frames of loop and drives on a bus: SYNC and process data, and heartbeats where the bus takes its time.
BusLoad load_on_bus(int axes, const Timing& timing, const std::optional<TimedBus>& timed);

/// How long the loop waits, and how long answers take: with the remedy.
std::string explain_times(int axes, const Timing& timing, const TimedBus& bus);

/// Exchanges by which commands are held back, so that with the tick of the bus the delay is that of
/// `timing`. Throws std::invalid_argument, with the remedy, where no bus can keep that.
std::size_t exchanges_held(const Timing& timing);

/// A plant behind a bus as one device of the loop. The drives add one tick of delay; `delay` ticks
/// in all are kept by holding the commands back.
template <Device D>
class ThroughCan {
 public:
  ThroughCan(D plant, const DeviceModel& device, const Timing& timing,
             const std::optional<TimedBus>& timed = {})
      : bench_(std::make_unique<CanTestBench<D>>(std::move(plant), device, timing.dt, timed)),
        held_(exchanges_held(timing)),
        times_(timed ? ": " + explain_times(device.axes(), timing, *timed) : "") {}

  Reading exchange(const Command& command) EBAC_RT { return bench_->exchange(hold(command)); }
  void stop() EBAC_RT { bench_->can().stop(); }
  /// From now on the hand wants to be at `target` [m]; one that is not finite changes nothing.
  void aim(std::size_t axis, double target) EBAC_RT
    requires requires(D& d) { d.aim(axis, target); }
  {
    if (std::isfinite(target)) bench_->joystick().plant().aim(axis, target);
  }

  auto parts() const EBAC_RT { return std::tie(bench_->plant(), std::as_const(*bench_).can()); }
  CanTestBench<D>& bench() EBAC_RT { return *bench_; }

  /// Enables the drives before the first tick, without time passing for the plant. Throws
  /// std::runtime_error with their fault when they do not come up; where the bus takes time,
  /// std::invalid_argument with its times.
  void switch_on() {
    bench_->can().enable();
    settle([this] { return bench_->can().running(); });
    if (bench_->can().running()) return;
    if (bench_->bus().timed()) throw std::invalid_argument(failure("reach operation enabled"));
    throw std::runtime_error(failure("reach operation enabled"));
  }
  /// Disables them after the last one. A drive that is in its fault state is off already; one that
  /// the bus no longer reaches is off once its own watches have acted.
  void switch_off() {
    bench_->can().disable();
    const auto off = [this] {
      return bench_->bus().timed() ? bench_->off() : bench_->can().at_rest();
    };
    settle(off);
    if (!off()) throw std::runtime_error(failure("switch off"));
  }

 private:
  template <class Done>
  void settle(Done done) {
    const int most = bench_->bus().timed() ? 2000 : 20;
    for (int i = 0; i < most && !done(); ++i) static_cast<void>(exchange({}));
  }
  std::string failure(const char* what) const {
    return std::string("the simulated drives did not ") + what + "; fault " +
           std::to_string(static_cast<unsigned>(std::as_const(*bench_).can().fault())) + times_;
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
  std::string times_;
};

/// Throws std::invalid_argument, with the remedy, for a timing that no such bus can keep.
void check_through_can(int axes, const Timing& timing, const std::optional<TimedBus>& timed = {});

/// The device of a run: `Plant` is made from the setup, with torque in whole thousandths and the
/// delay left to the bus.
template <Device Plant, class Setup>
ThroughCan<Plant> device_through_can(const Setup& setup,
                                     const std::optional<TimedBus>& timed = {}) {
  check_through_can(setup.device.axes(), setup.timing, timed);
  Setup behind = setup;
  behind.timing.delay = 0;
  behind.device.drive.permille = true;
  return ThroughCan<Plant>(Plant(behind), setup.device, setup.timing, timed);
}

/// Runs `setup` under `law` to its end through a bus and returns every row: `rows` of them, or
/// fewer after a fault. The drives are enabled before the first tick and disabled after the last.
template <Device Plant, class Setup, AxesController Law>
std::shared_ptr<Trace> simulate_through_can(const Setup& setup, Law law, std::size_t rows,
                                            const std::optional<TimedBus>& timed = {}) {
  auto device = device_through_can<Plant>(setup, timed);
  device.switch_on();
  const SignalChain chain(setup.device, setup.environment, law.timing(),
                          observing(setup.observer, law));
  Loop loop(std::move(device), VirtualClock(setup.timing.dt, setup.jitter, setup.seed),
            std::move(law), chain, setup.device.axes(), setup.loop);
  auto trace = loop.make_trace(rows);
  loop.run(*trace);
  loop.device().switch_off();
  return trace;
}

}  // namespace ebac::can
