#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

#include "ebac/loop/held_back_commands.hpp"
#include "ebac/loop/virtual_clock.hpp"
#include "ebac/sim/simulated_device.hpp"
#include "ebac/simulated_drives/through_can.hpp"
#include "running.hpp"

namespace ebac::python {

/// A simulated run through CAN on a virtual clock, which takes its ticks when it is asked to. It can be changed as one in
/// real time: the same orders at the same ticks give the same bits.
class SteppedRun final : public Running {
 public:
  /// Enables the drives; no tick yet. Keeps the last `rows` rows. Throws as `simulate_through_can`.
  SteppedRun(const AnyLaw& law, Setup setup, const std::optional<can::TimedBus>& bus,
             std::size_t rows);

  /// Takes so many ticks, fewer where the run ends; returns how many.
  std::int64_t advance(std::int64_t ticks);
  /// From the next tick on the hand wants to be there [m]; an axis that is not finite stays as it is. Unlike a target
  /// that is posted it is not noted.
  void aim(const std::array<double, kMaxAxes>& target);
  /// Disables the drives. Throws std::runtime_error when one stays on.
  void switch_off();

  /// Takes the ticks of so much time [s].
  bool wait(double seconds) override;
  void join() override;
  bool done() const override { return done_.load(std::memory_order_acquire); }
  bool at_rest() const override { return loop_.device().device().bench().off(); }
  LoopState state() const override { return loop_.state(); }
  std::int64_t unrecorded() const override { return 0; }

 private:
  using Drives = HeldBackCommands<can::ThroughCan<SimulatedDevice>>;
  using Work = Loop<Drives, VirtualClock, All>;

  static Work loop(const AnyLaw& law, const Setup& setup, const std::optional<can::TimedBus>& bus);

  double dt_;  // s
  mutable Work loop_;
  std::mutex stepping_;
  std::atomic<bool> done_{false};
};

}  // namespace ebac::python
