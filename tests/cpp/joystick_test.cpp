// Drives on a plant: what a loop sees through PDOs is what the simulated device shows, to the bit.
#include "ebac/simulated_drives/joystick.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string_view>

#include "designed_law.hpp"
#include "ebac/sim/any_law.hpp"
#include "ebac/sim/simulate.hpp"
#include "same_bits.hpp"

namespace ebac::can::joystick_test {
namespace {

/// The plant behind the drives: no delay of its own, torque in whole thousandths.
SimulatedDevice plant_of(Setup setup) {
  setup.device.drive.permille = true;
  setup.timing.delay = 0;
  return SimulatedDevice(setup);
}

template <class J>
void must(J& joystick, std::size_t axis, std::uint16_t index, std::uint8_t sub,
          std::int64_t value) {
  ASSERT_EQ(joystick.drive(axis).write(index, sub, value), Abort::kNone)
      << std::hex << index << ":" << int{sub} << " = " << value;
}

/// Controlword and torque in, statusword, position and torque out, on every SYNC; enabled.
template <class J>
void commission(J& joystick) {
  for (std::size_t axis = 0; axis < joystick.axes(); ++axis) {
    const NodeId node = joystick.drive(axis).node();
    must(joystick, axis, 0x1400, 1, kInvalid | rpdo(1, node));
    must(joystick, axis, 0x1400, 2, 1);
    must(joystick, axis, 0x1600, 0, 0);
    must(joystick, axis, 0x1600, 1, 0x60400010);
    must(joystick, axis, 0x1600, 2, 0x60710010);
    must(joystick, axis, 0x1600, 0, 2);
    must(joystick, axis, 0x1400, 1, rpdo(1, node));
    must(joystick, axis, 0x1800, 1, kInvalid | kNoRemote | tpdo(1, node));
    must(joystick, axis, 0x1800, 2, 1);
    must(joystick, axis, 0x1A00, 0, 0);
    must(joystick, axis, 0x1A00, 1, 0x60410010);
    must(joystick, axis, 0x1A00, 2, 0x60640020);
    must(joystick, axis, 0x1A00, 3, 0x60770010);
    must(joystick, axis, 0x1A00, 0, 3);
    must(joystick, axis, 0x1800, 1, kNoRemote | tpdo(1, node));
    must(joystick, axis, 0x6060, 0, kCyclicTorque);
    must(joystick, axis, 0x2112, 0, 65535);  // i2t, which the simulated device has not
  }
  joystick.elapse(0);  // self-test done
  for (const std::int64_t word : {6, 7, 15}) {
    for (std::size_t axis = 0; axis < joystick.axes(); ++axis)
      must(joystick, axis, 0x6040, 0, word);
  }
  joystick.receive(frame(kNmt, {1, 0}));
  Frame dropped;
  while (joystick.take(dropped)) {
  }
}

/// A device of the loop that knows nothing but frames.
class OnTheBus {
 public:
  using State = SimulatedDevice::State;
  static constexpr std::string_view kPrefix = "true.";  // of its columns
  using J = Joystick<SimulatedDevice>;

  OnTheBus(std::shared_ptr<J> joystick, const DeviceModel& device)
      : joystick_(std::move(joystick)),
        one_(device.motor.current(device.motor.rated_torque) / 1000),
        peak_(device.drive.peak_current(device.motor)) {}

  Reading exchange(const Command& command) EBAC_RT {
    if (command.elapsed > 0) joystick_->elapse(command.elapsed);
    for (std::size_t axis = 0; axis < joystick_->axes(); ++axis) {
      const double asked = std::clamp(command.current[axis], -peak_, peak_);
      Frame out{.id = rpdo(1, joystick_->drive(axis).node()), .size = 4};
      put<std::uint16_t>(out.data, 0, 15);
      put<std::int16_t>(out.data, 2, static_cast<std::int16_t>(std::lround(asked / one_)));
      joystick_->receive(out);
    }
    joystick_->receive(frame(kSync, {}));
    Reading reading;
    Frame in;
    while (joystick_->take(in)) {
      const std::size_t axis = in.id - tpdo(1, joystick_->drive(0).node());
      if (axis >= joystick_->axes()) continue;
      EXPECT_EQ(in.size, 8);
      EXPECT_EQ(get<std::uint16_t>(in.bytes(), 0) & 0x6F, 0x27);
      reading.counts[axis] = get<std::int32_t>(in.bytes(), 2);
      reading.current_applied[axis] = one_ * get<std::int16_t>(in.bytes(), 6);
    }
    reading.force = joystick_->reading().force;
    return reading;
  }
  const State& state(std::size_t axis) const EBAC_RT { return joystick_->plant().state(axis); }

 private:
  std::shared_ptr<J> joystick_;
  double one_;   // A per permille
  double peak_;  // A
};

void expect_same_rows(const char* name, Setup setup) {
  setup.device.drive.permille = true;
  setup.timing.delay = 1;
  const AnyLaw law = designed_law(name, setup);
  const auto plain = simulate_any(setup, law);

  auto joystick = std::make_shared<Joystick<SimulatedDevice>>(plant_of(setup), setup.device);
  commission(*joystick);
  Loop loop(OnTheBus(joystick, setup.device),
            VirtualClock(setup.timing.dt, setup.jitter, setup.seed), PerAxis<AnyLaw>(law),
            SignalChain(setup.device, setup.environment, setup.timing), setup.device.axes());
  const auto bussed = loop.make_trace(row_count(setup));
  loop.run(*bussed);

  expect_same_bits(*bussed, *plain);
  EXPECT_NE(plain->sample(plain->size() / 2).axis[0].port.f_applied, 0);
}

TEST(Joystick, EqualsTheSimulatedDeviceToTheBit) {
  expect_same_rows("ebac", {});
  expect_same_rows("direct", {});  // swings between the limits of the drive
}

TEST(Joystick, EqualsItWithNoiseAndJitter) {
  ebac::Setup setup{.seconds = 2, .jitter = 0.2, .seed = 7};
  setup.device.sensor = {.noise = 0.2, .quantum = 0.01};
  setup.hand.tremor_amplitude = 1e-3;
  expect_same_rows("eba", setup);
}

TEST(Joystick, EqualsItOnTwoCoupledAxes) {
  ebac::Setup setup{.seconds = 2};
  setup.device.kinematics = Gimbal{};
  setup.environment = Wall{.angle = 0.5};
  expect_same_rows("ebac", setup);
}

TEST(Joystick, OnlyTheDriveThatIsAskedAnswers) {
  ebac::Setup setup;
  setup.device.kinematics = Gimbal{};
  Joystick<SimulatedDevice> joystick(plant_of(setup), setup.device);
  joystick.receive(frame(sdo_request(2), {0x40, 0x00, 0x10, 0, 0, 0, 0, 0}));
  joystick.receive(frame(sdo_request(3), {0x40, 0x00, 0x10, 0, 0, 0, 0, 0}));  // no such node
  Frame said;
  for (const Frame& expected : {frame(heartbeat(1), {0}), frame(heartbeat(2), {0}),
                                frame(sdo_answer(2), {0x43, 0x00, 0x10, 0, 0x92, 1, 2, 0})}) {
    ASSERT_TRUE(joystick.take(said));
    EXPECT_EQ(said, expected);
  }
  EXPECT_FALSE(joystick.take(said));
}

TEST(Joystick, FollowsTheTimeWithoutSync) {
  ebac::Setup setup{.environment = Free{}};
  Joystick<SimulatedDevice> joystick(plant_of(setup), setup.device);
  SimulatedDevice alone = plant_of(setup);
  static_cast<void>(alone.exchange({}));
  for (int tick = 0; tick < 1000; ++tick) {
    joystick.elapse(1e-3);
    const Reading reading = alone.exchange({.elapsed = 1e-3});
    ASSERT_EQ(joystick.drive(0).objects().get<0x6064>(), reading.counts[0]) << tick;
  }
  EXPECT_GT(joystick.plant().state(0).x, 0.01);
}

TEST(Joystick, FaultStopsItsAxisWithinTheTick) {
  ebac::Setup setup{.environment = Free{}};
  setup.hand = {.stiffness = 0};
  setup.device.drive.current_lag = 0;
  Joystick<SimulatedDevice> joystick(plant_of(setup), setup.device);
  commission(joystick);
  must(joystick, 0, 0x6071, 0, -500);
  joystick.receive(frame(kSync, {}));
  const double current = joystick.drive(0).current();
  EXPECT_LT(current, 0);
  joystick.elapse(0.4e-3);
  must(joystick, 0, 0x5F00, 0, static_cast<std::int64_t>(Condition::kOverVoltage));
  joystick.elapse(0.6e-3);
  joystick.receive(frame(kSync, {}));

  SimulatedDevice alone = plant_of(setup);
  static_cast<void>(alone.exchange({.current = {current}, .elapsed = 0.4e-3}));
  static_cast<void>(alone.exchange({.current = {0}, .elapsed = 0.6e-3}));
  EXPECT_GT(alone.state(0).v, 0);
  EXPECT_EQ(joystick.plant().state(0).v, alone.state(0).v);
}

/// Without a SYNC the plant moves in steps, of which the last may be no more than a rounding.
TEST(Joystick, GoesOnByAnyTimeWithoutSync) {
  ebac::Setup setup;
  setup.hand.path[0] = MinimumJerk{};
  for (int ms = 1; ms <= 200; ++ms) {
    Joystick<SimulatedDevice> joystick(plant_of(setup), setup.device);
    joystick.elapse(1e-3 * ms);
    EXPECT_TRUE(std::isfinite(joystick.plant().state(0).x)) << ms << " ms";
  }
}

}  // namespace
}  // namespace ebac::can::joystick_test
