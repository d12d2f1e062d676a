// What a tick promises: when a command acts, and that nothing but zero current follows what is no
// number.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ebac/control/ebac.hpp"
#include "ebac/sim/simulate.hpp"

namespace ebac::tick_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kHuge = std::numeric_limits<double>::max();

/// Commands whatever a script says, tick by tick.
struct Scripted {
  struct State {
    static constexpr auto fields() { return std::array<Field<State>, 0>{}; }
  };
  std::vector<double> force;  // N
  std::size_t tick = 0;

  void step(std::span<Axis> axes, const ContactForce&) EBAC_RT {
    for (Axis& axis : axes) axis.port.f_cmd = tick < force.size() ? force[tick] : 0.0;
    ++tick;
  }
  void reset() EBAC_RT { tick = 0; }
  Timing timing() const EBAC_RT { return {}; }
};

/// Returns the readings of a script, the last one for ever, and records its commands.
struct FakeDevice {
  std::vector<Reading> script;
  std::vector<double>* currents;  // A
  std::size_t tick = 0;

  Reading exchange(const Command& command) EBAC_RT {
    currents->push_back(command.current[0]);
    return script[std::min(tick++, script.size() - 1)];
  }
};

Reading reading(double force, Fault fault = Fault::kNone) {
  Reading r{.fault = fault};
  r.force[0] = force;
  return r;
}

class Delay : public testing::TestWithParam<int> {};

TEST_P(Delay, CommandOfTickActsThatManyTicksLater) {
  const int delay = GetParam();
  ebac::Setup setup{.environment = Free{}, .timing = {.delay = delay}, .seconds = 0.1};
  setup.device.drive.current_lag = 0;
  setup.hand = {.stiffness = 0};
  std::vector<double> script(101);
  for (int k = 0; k < 101; ++k) script[static_cast<std::size_t>(k)] = k % 7 - 3.25;
  const auto trace = simulate(setup, Scripted{script});

  ASSERT_EQ(trace->size(), 101);
  for (std::size_t row = 0; row < trace->size(); ++row) {
    // A row describes the interval that ended with it; the one that starts at tick k ends at k + 1.
    const std::size_t late = static_cast<std::size_t>(delay) + 1;
    const double acting = row < late ? 0.0 : trace->sample(row - late).axis[0].port.f_cmd;
    EXPECT_NEAR(trace->sample(row).axis[0].port.f_applied, acting, 1e-12) << "row " << row;
  }
}

TEST_P(Delay, HandleMovesFromThatTickOn) {
  const int delay = GetParam();
  ebac::Setup setup{.environment = Free{}, .timing = {.delay = delay}};
  setup.hand = {.stiffness = 0};
  SimulatedDevice device(setup);
  static_cast<void>(device.exchange({}));
  for (int tick = 1; tick <= delay + 1; ++tick) {  // 1 A, computed in tick 0
    EXPECT_EQ(device.state(0).v, 0) << "before exchange " << tick;
    static_cast<void>(device.exchange({.current = {tick == 1 ? 1.0 : 0.0}, .elapsed = 1e-3}));
  }
  EXPECT_LT(device.state(0).v, 0);
}

INSTANTIATE_TEST_SUITE_P(, Delay, testing::Range(0, 4));

/// A loop on a fake device, run to its end.
struct LoopRun {
  std::vector<double> currents;
  std::shared_ptr<Trace> trace;

  LoopRun(const std::vector<Reading>& readings, const Scripted& law, const DeviceModel& model = {},
          const Environment& environment = Wall{}) {
    Loop loop(FakeDevice{readings, &currents}, VirtualClock(1e-3, 0, 1), law,
              SignalChain(model, environment, {}), 1);
    trace = loop.make_trace(1000);
    loop.run(*trace);
  }

  /// Ran until `tick`, then with zero force and the fault for the ticks of a stop.
  void expect_stop(std::size_t tick, Fault fault) const {
    constexpr int kStopTicks = RunPlan{}.stop_ticks;
    ASSERT_EQ(trace->size(), tick + kStopTicks);
    for (std::size_t row = 0; row < trace->size(); ++row) {
      const Sample sample = trace->sample(row);
      const Axis& axis = sample.axis[0];
      if (row < tick) {
        EXPECT_EQ(sample.fault, Fault::kNone) << "row " << row;
        EXPECT_NE(axis.joint.current, 0) << "row " << row;
      } else {
        EXPECT_EQ(sample.fault, fault) << "row " << row;
        EXPECT_EQ(axis.port.f_cmd, 0) << "row " << row;
        EXPECT_EQ(axis.joint.tau, 0) << "row " << row;
        EXPECT_EQ(axis.joint.current, 0) << "row " << row;
      }
      // The device hears of a row's current in the next exchange.
      if (row > 0) {
        EXPECT_EQ(currents[row], trace->sample(row - 1).axis[0].joint.current);
      }
    }
  }
};

std::vector<Reading> quiet() { return {reading(1)}; }
Scripted steady() { return {std::vector<double>(1000, 2.0)}; }

std::vector<Reading> readings_with(std::size_t tick, const Reading& odd) {
  std::vector<Reading> all(1000, reading(1));
  all[tick] = odd;
  return all;
}

Scripted forces_with(std::size_t tick, double odd) {
  Scripted law = steady();
  law.force[tick] = odd;
  return law;
}

TEST(Fault, ForceSensorGivesNoNumber) {
  LoopRun(readings_with(20, reading(kNaN)), steady()).expect_stop(20, Fault::kForceNotFinite);
  LoopRun(readings_with(20, reading(-kAnyHigh)), steady()).expect_stop(20, Fault::kForceNotFinite);
}

TEST(Fault, LawAnswersNoNumber) {
  LoopRun(quiet(), forces_with(20, kNaN)).expect_stop(20, Fault::kLawNotFinite);
  LoopRun(quiet(), forces_with(20, kAnyHigh)).expect_stop(20, Fault::kLawNotFinite);
}

TEST(Fault, DriveTellsOfNoCurrent) {
  Reading odd = reading(1);
  odd.current_applied[0] = kNaN;
  LoopRun(readings_with(20, odd), steady()).expect_stop(20, Fault::kDevice);
}

TEST(Fault, DeviceReportsOne) {
  LoopRun(readings_with(20, reading(1, Fault::kDevice)), steady()).expect_stop(20, Fault::kDevice);
}

TEST(Fault, EnvironmentAsksForNoNumber) {
  std::vector<Reading> inside(1000, reading(1));
  for (std::size_t k = 20; k < inside.size(); ++k) inside[k].counts[0] = 1000;
  LoopRun(inside, steady(), {}, Wall{.stiffness = kHuge, .damping = kHuge, .position = 1e-3})
      .expect_stop(20, Fault::kEnvironmentNotFinite);
}

TEST(Fault, PositionIsNoNumber) {
  DeviceModel broken;
  broken.capstan.drum_radius = kNaN;
  LoopRun(quiet(), steady(), broken).expect_stop(0, Fault::kPositionNotFinite);
}

TEST(Fault, TorqueIsNoNumber) {
  DeviceModel long_lever;
  long_lever.kinematics = Linear{.radius = 10};
  LoopRun(quiet(), forces_with(20, kHuge), long_lever).expect_stop(20, Fault::kTorqueNotFinite);
}

TEST(Fault, FirstOneWins) {
  // Within a tick, the order of the stages; between ticks, the order of time.
  LoopRun(readings_with(20, reading(kNaN)), forces_with(20, kNaN))
      .expect_stop(20, Fault::kForceNotFinite);
  LoopRun(readings_with(20, reading(kNaN)), forces_with(19, kNaN))
      .expect_stop(19, Fault::kLawNotFinite);
  LoopRun(readings_with(20, reading(kNaN, Fault::kDevice)), steady())
      .expect_stop(20, Fault::kDevice);
}

TEST(Fault, LargeNumbersAreNone) {
  // Finite each, although their sum is not.
  Axis axis;
  axis.port.f_env = axis.port.f_meas = kHuge;
  EXPECT_EQ(first_fault(axis), Fault::kNone);
}

TEST(Fault, EarliestStageOfAllAxesWins) {
  std::array<Axis, 3> axes{};
  axes[0].joint.tau = kNaN;
  axes[1].port.f_meas = kNaN;
  axes[2].port.f_cmd = kNaN;
  EXPECT_EQ(first_fault(axes), Fault::kForceNotFinite);
}

/// A device at a steady pace that answers some ticks only, or a tick late.
class Speed : public ::testing::TestWithParam<Velocity> {};

TEST_P(Speed, DoesNotLeapWhereAnswersAreMissing) {
  constexpr double kDt = 1e-3;
  constexpr int kPace = 10;  // counts a tick: 0.3 m/s
  DeviceModel model;
  model.velocity = GetParam();
  SignalChain chain(model, Free{}, {});
  std::array<Axis, 1> axes{};
  const double pace = kPace * model.encoder.count() / model.capstan.ratio() / kDt;
  Reading reading;
  for (int k = 0; k < 400; ++k) {
    const bool answered = k < 100 || k % 7 == 0;
    const bool late = k % 7 == 3;  // what comes now was latched a tick ago
    reading.counts_age[0] += kDt;
    if (answered || late) {
      reading.counts[0] = kPace * (late && !answered ? k - 1 : k);
      reading.counts_age[0] = late && !answered ? kDt : 0;
    }
    chain.measure(reading, k > 0 ? kDt : 0, axes);
    if (k > 90) {
      ASSERT_NEAR(axes[0].joint.dq, pace, 1e-6 * pace) << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Estimators, Speed,
                         ::testing::Values(Velocity{BackwardDifference{}},
                                           Velocity{LowPass{.time_constant = 2e-3}},
                                           Velocity{AdaptiveWindow{}}));

TEST(CompensationInFlight, ActsAfterTheDelayWithTheGainWithWhichItWasSent) {
  CompensationInFlight compensation(1);
  using Acted = std::pair<double, double>;  // N m, gain
  const auto next = [&](double given, double gain) {
    compensation.give(Axes::Constant(given));
    compensation.sent_with(gain);
    compensation.advance();
    return Acted(compensation.motion()[0], compensation.gain());
  };
  EXPECT_EQ(next(2, 0.5), Acted(0, 0));  // this command acts over the next interval
  EXPECT_EQ(next(4, 1), Acted(1, 0.5));
  EXPECT_EQ(next(kNaN, 0), Acted(4, 1));  // not sent: of a fault
  compensation.advance();                 // at rest no command is given
  EXPECT_EQ(Acted(compensation.motion()[0], compensation.gain()), Acted(0, 0));
  EXPECT_EQ(next(3, 1), Acted(0, 0));
  EXPECT_EQ(next(3, 1), Acted(3, 1));
}

/// Everything a tick needs, in a world that is met, left and met again.
struct Parts {
  Setup setup{.environment = Wall{.damping = 5}};
  SignalChain chain{setup.device, setup.environment, setup.timing};
  PerAxis<Ebac> law{Ebac(Ebac::Params::design(setup.device.facts(), setup.timing), setup.timing)};
  SimulatedDevice device{[this] {
    setup.hand.path[0] = Tapping{};
    return setup;
  }()};
  Sample sample{};
};

TEST(Tick, OfOneAxisHasTheBitsOfTheOneForSeveral) {
  Parts one, several;
  VirtualClock clock(one.setup.timing.dt, 0, 1);
  double force = 0;
  for (int k = 0; k < 3000; ++k) {
    const Instant now = clock.wait();
    tick(one.chain, one.law, one.device, now, one.sample);
    tick(several.chain, several.law, several.device, now, several.sample,
         axes_in_use(several.sample));
    ASSERT_EQ(std::memcmp(&one.sample.axis[0], &several.sample.axis[0], sizeof(Axis)), 0) << k;
    force = std::max(force, one.sample.axis[0].port.f_cmd);
  }
  EXPECT_GT(force, 5);  // N: there was a contact to compare
}

TEST(VirtualClock, WithoutJitterKeepsWholeTicksToTheBit) {
  constexpr double kDt = 0.7e-3;
  VirtualClock clock(kDt, 0, 1);
  for (std::int64_t k = 0; k < 100000; ++k) {
    const Instant now = clock.wait();
    const auto quanta = static_cast<double>(k * kQuanta);
    ASSERT_EQ(now.t, kDt * (quanta / static_cast<double>(kQuanta)));
    ASSERT_EQ(now.dt, k > 0 ? kDt : 0.0);
    ASSERT_EQ(now.lateness, 0);
  }
}

TEST(Fault, LatchesOnTheSimulatedDeviceToo) {
  const auto trace = simulate(ebac::Setup{}, forces_with(50, kNaN));
  ASSERT_EQ(trace->size(), 60);
  const Port last = trace->sample(59).axis[0].port;
  EXPECT_EQ(last.f_cmd, 0);
  EXPECT_EQ(last.f_applied, 0);
}

}  // namespace
}  // namespace ebac::tick_test
