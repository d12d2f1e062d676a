// A run through the bus gives the bits of one without: what the drives, the frames and the loop's
// side of the bus add is time, and nothing else.
#include "ebac/simulated_drives/through_can.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "designed_law.hpp"
#include "ebac/control/law_types.hpp"
#include "ebac/sim/any_law.hpp"
#include "same_bits.hpp"

namespace ebac::through_can_test {
namespace {

Setup quantised(Setup setup) {
  setup.device.drive.permille = true;
  return setup;
}

void expect_same_run(std::string_view name, const Setup& setup) {
  const AnyLaw law = designed_law(name, setup);
  const auto direct = simulate_any(quantised(setup), law);
  const auto through =
      can::simulate_through_can<SimulatedDevice>(setup, PerAxis<AnyLaw>(law), row_count(setup));
  expect_same_bits(*through, *direct);
  EXPECT_NE(direct->sample(direct->size() - 1).axis[0].joint.counts, 0);
}

/// Share of the ticks of a run in which the drive gave all it has.
double saturated(std::string_view name, const Setup& setup) {
  const auto trace = simulate_any(quantised(setup), designed_law(name, setup));
  const double peak = setup.device.drive.peak_current(setup.device.motor);
  double count = 0;
  for (std::size_t row = 0; row < trace->size(); ++row) {
    if (std::abs(trace->sample(row).axis[0].joint.current_applied) > 0.999 * peak) ++count;
  }
  return count / static_cast<double>(trace->size());
}

Setup brief() { return {.seconds = 1}; }

TEST(ThroughCan, GivesTheSameBitsUnderEveryLaw) {
  for (const LawType* type : law_types()) {
    SCOPED_TRACE(type->name);
    expect_same_run(type->name, brief());
  }
}

TEST(ThroughCan, WithEverySeed) {
  for (const std::uint64_t seed : {2ULL, 77ULL, 123456789ULL}) {
    auto setup = brief();
    setup.seed = seed;
    setup.device.sensor.noise = 0.1;
    expect_same_run("ebac", setup);
  }
}

TEST(ThroughCan, WithFriction) {
  auto setup = brief();
  setup.device.mechanics.coulomb = 0.5;
  setup.device.compensation.friction = 0.3;
  expect_same_run("ebac", setup);
}

TEST(ThroughCan, WithJitter) {
  auto setup = brief();
  setup.jitter = 0.3;
  setup.device.sensor.noise = 0.1;
  expect_same_run("eba", setup);
}

TEST(ThroughCan, WithTwoAxes) {
  auto setup = brief();
  setup.device.kinematics = Gimbal{};
  setup.environment = Wall{.angle = 0.5};
  expect_same_run("ebac", setup);
  setup.device.kinematics = Linear{.axes = 3};
  setup.environment = Corner{};
  expect_same_run("ebac", setup);
}

TEST(ThroughCan, WithEveryDelayTheBusCanHave) {
  for (int delay = 1; delay <= 8; ++delay) {
    auto setup = brief();
    setup.timing.delay = delay;
    setup.seconds = 0.3;
    expect_same_run("ebac", setup);
  }
}

TEST(ThroughCan, AtTheLimitsOfTheDrive) {
  auto setup = brief();
  setup.environment = Wall{.stiffness = 50e3};
  expect_same_run("tca", setup);                   // swings from limit to limit
  setup.device.motor.torque_constant = 0.0538123;  // which no drive can represent exactly
  setup.device.motor.rated_torque = 0.0527771;
  setup.device.drive.peak_ratio = 3.4567;
  EXPECT_GT(saturated("tca", setup), 0.1);
  expect_same_run("tca", setup);
}

TEST(ThroughCan, WithANarrowCounter) {
  auto setup = brief();
  setup.device.encoder.counter_bits = 8;
  expect_same_run("ebac", setup);
}

TEST(ThroughCan, TheBusIsInTheRowAndWell) {
  const auto setup = brief();
  const auto trace = can::simulate_through_can<SimulatedDevice>(
      setup, PerAxis<AnyLaw>(designed_law("eba", setup)), row_count(setup));
  std::size_t found = 0;
  for (const Column& column : trace->columns()) {
    const auto value = [&](std::size_t row) {
      std::int64_t number = 0;
      std::memcpy(&number, trace->data() + row * trace->row_bytes() + column.offset,
                  column.kind == 'w' ? 4 : 8);
      return number;
    };
    for (const char* name :
         {"bus.missing", "bus.late", "bus.duplicate", "bus.age", "bus.foreign"}) {
      if (column.name != name) continue;
      ++found;
      EXPECT_EQ(value(trace->size() - 1), value(0)) << name;
    }
    if (column.name == "bus.statusword") {
      for (std::size_t row = 0; row < trace->size(); ++row) EXPECT_EQ(value(row) & 0x6F, 0x27);
    }
  }
  EXPECT_EQ(found, 5);
}

TEST(ThroughCan, DrivesAreOffBeforeAndAfter) {
  auto device = can::device_through_can<SimulatedDevice>(brief());
  const auto state = [&] { return device.bench().joystick().drive(0).state(); };
  EXPECT_NE(state(), can::DriveState::kOperationEnabled);
  device.switch_on();
  EXPECT_EQ(state(), can::DriveState::kOperationEnabled);
  static_cast<void>(device.exchange({.current = {1.0}, .elapsed = 1e-3}));
  EXPECT_GT(device.bench().joystick().drive(0).current(), 0.9);
  device.switch_off();
  EXPECT_EQ(state(), can::DriveState::kSwitchOnDisabled);
  EXPECT_EQ(device.bench().joystick().drive(0).current(), 0);
}

TEST(ThroughCan, AFaultOfARealDriveEndsTheRunAtRest) {
  for (const auto& [condition, fault] :
       {std::pair{can::Condition::kOverVoltage, Fault::kDriveEmergency},
        std::pair{can::Condition::kSilent, Fault::kDriveSilent}}) {
    auto device = can::device_through_can<SimulatedDevice>(brief());
    device.switch_on();
    Loop loop(std::move(device), VirtualClock(1e-3, 0, 1),
              PerAxis<AnyLaw>(designed_law("direct", brief())),
              SignalChain(DeviceModel{}, Environment{Wall{.position = -0.01}}, {}), 1);
    auto first = loop.make_trace(5);
    loop.run(*first);
    EXPECT_EQ(loop.sample().fault, Fault::kNone);
    EXPECT_NE(loop.sample().axis[0].joint.current, 0);
    loop.device().bench().joystick().drive(0).set_condition(condition, true);
    auto second = loop.make_trace(100);
    loop.run(*second);
    EXPECT_EQ(loop.sample().fault, fault);
    EXPECT_LT(second->size(), 20);
    EXPECT_EQ(loop.sample().axis[0].joint.current, 0);
    if (condition == can::Condition::kOverVoltage) {
      EXPECT_EQ(loop.device().bench().joystick().drive(0).current(), 0);
    }
  }
}

TEST(ThroughCan, RefusesWhatABusCannotDo) {
  const auto run = [](const ebac::Setup& setup) {
    static_cast<void>(can::device_through_can<SimulatedDevice>(setup));
  };
  EXPECT_THROW(run({.timing = {.delay = 0}}), std::invalid_argument);
  EXPECT_THROW(run({.timing = {.dt = 2e-4}}), std::invalid_argument);
  EXPECT_NO_THROW(run({.timing = {.dt = 5e-4}}));  // one drive at 2 kHz: 57 %
}

TEST(ThroughCan, RefusesADelayThatItCannotKeep) {
  const auto setup = brief();
  for (const int delay : {0, 9}) {
    EXPECT_THROW(can::ThroughCan(SimulatedDevice(setup), setup.device, Timing{.delay = delay}),
                 std::invalid_argument)
        << delay;
  }
}

}  // namespace
}  // namespace ebac::through_can_test
