// A simulated run on a bus that takes time: late answers, bus-off, and drives at rest.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "ebac/control/direct.hpp"
#include "ebac/sim/simulated_device.hpp"
#include "ebac/simulated_drives/through_can.hpp"

namespace ebac::timed_bus_test {
namespace {

using Loop2 = Loop<can::ThroughCan<SimulatedDevice>, VirtualClock, PerAxis<Direct>>;

Setup two_axes() {
  Setup setup;
  setup.device.kinematics = Linear{.axes = 2};
  return setup;
}

Loop2 loop_on(const can::TimedBus& bus) {
  const Setup setup = two_axes();
  auto device = can::device_through_can<SimulatedDevice>(setup, bus);
  device.switch_on();
  return {std::move(device), VirtualClock(1e-3, 0, 1), PerAxis<Direct>(Direct({}, setup.timing)),
          SignalChain(setup.device, Environment{Wall{.position = -0.01}}, {}), 2};
}

const can::BusRow& row(Loop2& loop, std::size_t axis) {
  return loop.device().bench().can().state(axis);
}

TEST(TimedBus, TwoDrivesAtOneMegabitAreNeverLate) {
  Loop2 loop = loop_on({});
  loop.run(*loop.make_trace(1000));
  EXPECT_EQ(loop.sample().fault, Fault::kNone);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(row(loop, i).late, 0);
    EXPECT_EQ(row(loop, i).age, 0);
  }
}

TEST(TimedBus, ASlowBusIsRefusedBeforeTheRun) {
  EXPECT_THROW(loop_on({.bit_rate = 250e3}), std::invalid_argument);
  EXPECT_THROW(loop_on({.answer_share = 0.45}), std::invalid_argument);  // the least is 477 us
  EXPECT_THROW(loop_on({.answer_share = 0.5}), std::invalid_argument);   // at rest it takes more
}

TEST(TimedBus, AnyHeartbeatOfTheDrivesIsWatchedForThreeTimesAsLongAsItTakes) {
  EXPECT_EQ(can::can_setup({}, can::TimedBus{.drive_heartbeat = 60}).heartbeat_timeout, 180);
  EXPECT_NO_THROW(can::check_setup(can::can_setup({}, can::TimedBus{.drive_heartbeat = 60})));
  // A drive has whole milliseconds.
  EXPECT_EQ(can::can_setup({}, can::TimedBus{.drive_heartbeat = 1e-4}).heartbeat_timeout, 3e-3);
  EXPECT_EQ(can::can_setup({}, can::TimedBus{.drive_heartbeat = 0}).heartbeat_timeout, 0);
}

TEST(TimedBus, ADriveThatWaitsForLessThanATickIsRefused) {
  const auto refused = [](const can::TimedBus& bus, double dt) -> std::string {
    try {
      can::check_through_can(1, {.dt = dt}, bus);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused({.torque_silence = 0.0016}, 0.0012), "");
  const std::string torque = refused({.torque_silence = 0.0014}, 0.0012);  // 1 ms of a drive
  EXPECT_NE(torque.find("TimedBus.torque_silence = 0.0014 s"), std::string::npos) << torque;
  EXPECT_EQ(refused({.loop_silence = 0.02, .torque_silence = 0}, 0.01), "");
  const std::string loop = refused({.loop_silence = 0.005, .torque_silence = 0}, 0.01);
  EXPECT_NE(loop.find("TimedBus.loop_silence = 0.005 s"), std::string::npos) << loop;
  // The loop's heartbeat comes with the second tick, after 1.4 ms.
  EXPECT_NE(refused({.loop_silence = 0.001, .torque_silence = 0}, 0.0007), "");
  EXPECT_EQ(refused({.loop_silence = 0.002, .torque_silence = 0}, 0.0007), "");
}

constexpr can::TimedBus kManyBeats{.drive_heartbeat = 1e-3, .loop_silence = 0.01};

TEST(TimedBus, HeartbeatsCountAsThePdosDo) {
  // SYNC and process data of three drives take 745 us of a millisecond, four heartbeats 260 us more.
  EXPECT_NO_THROW(can::check_through_can(3, {}, can::TimedBus{.answer_share = 0.9}));
  can::TimedBus beats = kManyBeats;
  beats.answer_share = 0.9;
  EXPECT_THROW(can::check_through_can(3, {}, beats), std::invalid_argument);
  const std::string times = can::explain_times(2, {}, {});  // any of them may come in between
  EXPECT_NE(times.find("after 477 to 760 us"), std::string::npos) << times;
}

TEST(TimedBus, NoMoreComesOnTheBusThanItsPlanSays) {
  for (const can::TimedBus& bus : {can::TimedBus{}, kManyBeats}) {
    Loop2 loop = loop_on(bus);
    const can::SimulatedWire& wire = *std::as_const(loop.device().bench()).bus().wire();
    const std::int64_t before = wire.busy();
    loop.run(*loop.make_trace(1000));
    EXPECT_EQ(loop.sample().fault, Fault::kNone);
    const double used = static_cast<double>(wire.busy() - before) / 1e9;  // of a second
    const double share = can::load_on_bus(2, {}, bus).share();
    EXPECT_LE(used, share);
    EXPECT_GE(used, 0.8 * share);
  }
}

TEST(TimedBus, ABusWithoutTimeHasNoHeartbeats) {
  EXPECT_EQ(can::load_on_bus(2, {}, {}).bits(), 515);
  EXPECT_EQ(can::load_on_bus(2, {}, can::TimedBus{.drive_heartbeat = 0, .loop_silence = 0}).bits(),
            515);
}

TEST(TimedBus, OffTheBusMeansZeroForceAndDrivesAtRest) {
  for (const can::TimedBus& bus : {can::TimedBus{.broken = 1, .broken_from = 0.1},
                                   can::TimedBus{.broken = 2, .broken_from = 0.1},
                                   can::TimedBus{.error_rate = 0.13, .seed = 1},
                                   can::TimedBus{.error_rate = 0.13, .seed = 2}}) {
    Loop2 loop = loop_on(bus);
    const auto trace = loop.make_trace(3000);
    loop.run(*trace);
    const Fault fault = loop.sample().fault;
    EXPECT_TRUE(fault == Fault::kDriveSilent || fault == Fault::kBusDown ||
                fault == Fault::kDriveEmergency)
        << static_cast<unsigned>(fault);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(loop.sample().axis[i].joint.current, 0);
    loop.device().switch_off();
    EXPECT_TRUE(loop.device().bench().off());
  }
}

TEST(TimedBus, TheLoopsOwnControllerOffTheBusIsABusThatIsDown) {
  can::TimedBus bus;
  can::VirtualBus near{can::SimulatedWire(can::wire_of(bus, 1))};
  near.wire()->set_error_rate(can::VirtualBus::kLoop, 1);
  EXPECT_TRUE(near.send({.id = can::kSync}));
  while (near.advance(20'000'000)) {
  }
  EXPECT_EQ(near.state(), can::BusState::kBusOff);
  EXPECT_FALSE(near.send({.id = can::kSync}));
  while (near.advance(1'000'000'000)) {
  }
  EXPECT_EQ(near.state(), can::BusState::kBusOff);  // restarted by hand
}

}  // namespace
}  // namespace ebac::timed_bus_test
