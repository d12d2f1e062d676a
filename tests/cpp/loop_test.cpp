// What a loop promises whatever its device and its law: no force before the device is ready nor after
// a fault, limited force in between, and a device that is told when to go off.
// Device and law are this file's own: so the loop is compiled here, not taken from the library.
#include "ebac/loop/loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ebac/core/clock.hpp"
#include "ebac/core/device.hpp"

namespace ebac::loop_test {
namespace {

constexpr double kDt = 1e-3;  // s
constexpr int kStopTicks = RunPlan{}.stop_ticks;
const DeviceModel kDevice{};

/// What device and law were asked for.
struct Asked {
  std::vector<double> current{};  // A, in each exchange
  int enable = 0, disable = 0, stop = 0;
  int steps = 0;  // of the law
};

/// Is ready after some exchanges, and shows a position and a force from some exchange on.
struct FakeDevice {
  Asked* asked = nullptr;
  int ready_after = 0;
  int from = 0;
  double position = 0;  // m
  double force = 0;     // N

  Reading exchange(const Command& command) EBAC_RT {
    asked->current.push_back(command.current[0]);
    Reading reading;
    if (std::ssize(asked->current) > from) {
      reading.counts[0] = std::llround(position / kDevice.count());
      reading.force[0] = force;
    }
    return reading;
  }
  void enable() EBAC_RT { ++asked->enable; }
  void disable() EBAC_RT { ++asked->disable; }
  void stop() EBAC_RT { ++asked->stop; }
  bool running() const EBAC_RT { return std::ssize(asked->current) > ready_after; }
};

/// Commands one force.
struct FakeLaw {
  struct State {
    static constexpr auto fields() { return std::array<Field<State>, 0>{}; }
  };
  double force;  // N
  Asked* asked;

  void step(std::span<Axis> axes, const ContactForce&) EBAC_RT {
    ++asked->steps;
    for (Axis& axis : axes) axis.port.f_cmd = force;
  }
  void reset() EBAC_RT {}
};

/// On time, but for one pause.
struct FakeClock {
  std::int64_t pause_at = -1;
  std::int64_t tick = 0;
  double t = 0;

  Instant wait() EBAC_RT {
    const std::int64_t skipped = tick == pause_at ? 50 : 0;
    const double dt = tick++ > 0 ? kDt * static_cast<double>(1 + skipped) : 0.0;
    t += dt;
    return {.t = t, .dt = dt, .lateness = 0, .skipped = skipped};
  }
};

/// A loop on a fake device, run to its end.
struct LoopRun {
  Asked asked{};
  LoopState end = LoopState::kIdle;
  bool again = false;  // whether it starts once more
  std::vector<Sample> rows{};

  LoopRun(FakeDevice device, double force, const LoopOptions& options, FakeClock clock = {}) {
    device.asked = &asked;
    Loop loop(device, clock, FakeLaw{force, &asked}, SignalChain(kDevice, Environment{Free{}}, {}),
              1, options);
    const auto trace = loop.make_trace(2000);
    EXPECT_TRUE(loop.run(*trace));
    end = loop.state();
    for (std::size_t row = 0; row < trace->size(); ++row) rows.push_back(trace->sample(row));
    const Asked before = asked;
    again = loop.run(*trace);
    asked = before;
  }

  /// The current of a row [A], which the device is given in the next exchange.
  double current(std::size_t row) const { return rows[row].axis[0].joint.current; }
  std::ptrdiff_t rows_in(LoopState state) const {
    return std::ranges::count(rows, static_cast<int>(state), &Sample::state);
  }
  void expect_given_as_recorded() const {
    ASSERT_EQ(asked.current.size(), rows.size());
    for (std::size_t row = 1; row < rows.size(); ++row) {
      EXPECT_EQ(asked.current[row], current(row - 1)) << row;
    }
  }
  /// Force until row `from`; then none, by this fault, with a device that is stopped in every tick.
  void expect_fault(Fault fault, std::size_t from) const {
    ASSERT_EQ(rows.size(), from + kStopTicks);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      EXPECT_EQ(rows[row].fault, row < from ? Fault::kNone : fault) << row;
      EXPECT_EQ(current(row) == 0, row >= from) << row;
    }
    expect_given_as_recorded();
    EXPECT_EQ(asked.stop, kStopTicks);
    EXPECT_EQ(asked.disable, 0);
    EXPECT_EQ(end, LoopState::kFault);
    EXPECT_FALSE(again) << "nothing starts again by itself";
  }
};

SafetyLimiter limiter(const Limits& limits = Limits::of(kDevice)) { return {limits, kDevice, kDt}; }

TEST(Loop, AsksTheLawForNothingBeforeTheDeviceIsReady) {
  const LoopRun run({.ready_after = 20}, 5,
                    {.plan = {.arm = true, .ticks = 100}, .limiter = limiter()});
  EXPECT_EQ(run.asked.enable, 1);
  EXPECT_EQ(run.rows_in(LoopState::kArm), 20);
  EXPECT_EQ(run.rows_in(LoopState::kRun), 100);
  for (std::size_t row = 0; row < 20; ++row) {
    EXPECT_EQ(run.rows[row].axis[0].port.f_cmd, 0) << row;
    EXPECT_EQ(run.current(row), 0) << row;
  }
  EXPECT_EQ(run.asked.steps, std::ssize(run.rows) - 20) << "the law has no memory of that time";
  EXPECT_GT(run.current(20), 0);
  run.expect_given_as_recorded();
}

TEST(Loop, RampsTheForceInAndOut) {
  const LoopRun run({}, 5,
                    {.plan = {.soft_start = 0.1, .ramp_down = 0.05, .arm = true, .ticks = 500},
                     .limiter = limiter()});
  ASSERT_EQ(run.rows.size(), 500 + 50 + kStopTicks - 1);
  const double whole = run.current(300);
  EXPECT_NEAR(kDevice.force(whole), 5, 1e-9);
  EXPECT_NEAR(run.current(25), whole * 25 / 100, 1e-12);
  EXPECT_NEAR(run.current(520), whole * 29 / 50, 1e-12);
  for (std::size_t row = 549; row < run.rows.size(); ++row) EXPECT_EQ(run.current(row), 0) << row;
  EXPECT_EQ(run.end, LoopState::kIdle);
}

TEST(Loop, DisablesTheDeviceInEveryTickOfAGoodEnd) {
  const LoopRun run({}, 5, {.plan = {.arm = true, .ticks = 50}, .limiter = limiter()});
  EXPECT_EQ(run.asked.disable, kStopTicks);
  EXPECT_EQ(run.asked.stop, 0);
  EXPECT_EQ(run.end, LoopState::kIdle);
  EXPECT_TRUE(run.again);
}

TEST(Loop, GivesTheDeviceNoCurrentBeyondTheLimit) {
  Limits limits = Limits::of(kDevice);
  limits.continuous_current = limits.peak_current = 0.5;  // far below what the drive would give
  for (const double force : {30.0, -30.0}) {
    const LoopRun run({}, force, {.plan = {.arm = true, .ticks = 50}, .limiter = limiter(limits)});
    for (std::size_t row = 0; row < 50; ++row) {
      EXPECT_EQ(run.current(row), std::copysign(0.5, force)) << row;
      EXPECT_NE(run.rows[row].limited & static_cast<int>(Limited::kPeak), 0) << row;
    }
    run.expect_given_as_recorded();
  }
}

TEST(Loop, APauseLeavesNoCurrentAndTheForceComesInAnew) {
  Limits limits = Limits::of(kDevice);
  limits.slew = 20;  // A/s: by the slew alone it would take 23 ticks to zero
  limits.pause = 0.1;
  const LoopRun run(
      {}, 5, {.plan = {.soft_start = 0.05, .arm = true, .ticks = 300}, .limiter = limiter(limits)},
      {.pause_at = 200});
  EXPECT_GT(run.current(199), 0.4);
  EXPECT_EQ(run.current(200), 0);
  EXPECT_GT(run.current(210), 0);
  EXPECT_LT(run.current(210), 0.5 * run.current(199));
}

TEST(Loop, EndsWhereAnAxisLeavesTheWorkspace) {
  Limits limits = Limits::of(kDevice);
  limits.jump = 1;
  limits.speed = 100;
  for (const double side : {1.0, -1.0}) {
    LoopRun({.from = 40, .position = side * 1.01 * limits.end}, 5,
            {.plan = {.arm = true, .ticks = 100}, .limiter = limiter(limits)})
        .expect_fault(Fault::kWorkspace, 40);
  }
}

TEST(Loop, EndsWhereAHandPushesAndTheEncoderShowsNothing) {
  const LoopRun run({.from = 40, .force = 20}, 5,
                    {.plan = {.arm = true, .ticks = 1000}, .limiter = limiter()});
  const auto known = std::ranges::count(run.rows, Fault::kNone, &Sample::fault);
  EXPECT_NEAR(static_cast<double>(known), 40 + 40, 20);
  run.expect_fault(Fault::kEncoderFrozen, static_cast<std::size_t>(known));
}

}  // namespace
}  // namespace ebac::loop_test
