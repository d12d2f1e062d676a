#pragma once

#include <chrono>
#include <cstdint>
#include <thread>

#include "ebac/canopen/canopen_device.hpp"

/// The loop's device in real time, without a loop around it.
namespace ebac::can {

/// Looks for answers for a budget, and lets others run meanwhile: they may share its core.
class YieldFor {
 public:
  explicit YieldFor(std::chrono::nanoseconds budget) : budget_(budget) {}
  void begin(double) noexcept { end_ = std::chrono::steady_clock::now() + budget_; }
  bool more() const noexcept {
    std::this_thread::yield();
    return std::chrono::steady_clock::now() < end_;
  }

 private:
  std::chrono::nanoseconds budget_;
  std::chrono::steady_clock::time_point end_;
};

/// What a run came to.
struct TimedRun {
  bool ran = false;           // every drive was enabled
  bool rested = false;        // and off at the end
  Fault fault{};              // of the device
  int late = 0;               // ticks that began more than half a period late
  std::int64_t missing = 0;   // answers of drive 1 that did not come in their tick
  std::int64_t first = 0;     // counts of axis 0 when enabled
  std::int64_t last = 0;      // counts of axis 0 after the last tick
  double current_echoed = 0;  // A, reported by drive 1 in the last tick
};

/// Enables two drives, gives axis 0 a current for `ticks` of 1 ms, and disables them. A tick waits
/// for its answers far beyond that: a machine too slow for 1 kHz is late, and still right.
template <Bus B>
TimedRun run_in_real_time(B& bus, int ticks, double current) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kPeriod{1};
  constexpr std::chrono::milliseconds kBudget{200};
  constexpr int kMostTicks = 2000;
  CanopenDevice<B, YieldFor> device(bus, YieldFor(kBudget),
                                    {.axes = 2, .silent_ticks = 50, .enable_ticks = kMostTicks});
  TimedRun run;
  auto due = Clock::now();
  auto before = due;
  const auto tick = [&](double amperes) {
    due += kPeriod;
    std::this_thread::sleep_until(due);
    const auto now = Clock::now();
    if (now - due > kPeriod / 2) ++run.late;
    if (now - due > kPeriod) due = now;  // what is past is past
    const std::chrono::duration<double> elapsed = now - before;
    before = now;
    return device.exchange({.current = {amperes, 0, 0}, .elapsed = elapsed.count()});
  };
  bus.send(frame(kNmt, {0x01, 0}));
  device.enable();
  for (int i = 0; i < kMostTicks && !device.running() && device.fault() == Fault::kNone; ++i) {
    run.first = tick(0).counts[0];
  }
  run.ran = device.running();
  run.late = 0;
  Reading reading;
  for (int i = 0; i < ticks; ++i) reading = tick(current);
  const int late = run.late;
  run.last = reading.counts[0];
  run.current_echoed = reading.current_applied[0];
  run.fault = device.fault();
  run.missing = device.state(0).missing;
  device.disable();
  for (int i = 0; i < kMostTicks && !run.rested; ++i) {
    tick(0);
    run.rested = device.at_rest();
  }
  run.late = late;
  return run;
}

}  // namespace ebac::can
