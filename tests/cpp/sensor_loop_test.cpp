// Laws that close their loop on a force that came over the network: the numbers of one that did not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "designed_law.hpp"
#include "ebac/sensor/with_force_sensor.hpp"
#include "ebac/sim/any_law.hpp"
#include "through_udp.hpp"

namespace ebac::sensor::sensor_loop_test {
namespace {

using Device = WithForceSensor<ForcePublisher<SimulatedDevice>, StepSensor>;

/// 2^20 counts a newton, and a sensor whose steps they are: nothing is rounded twice.
constexpr double kCounts = 1048576;

Setup quantised() {
  Setup setup;
  setup.seconds = 2;
  setup.device.sensor.quantum = 1 / kCounts;
  setup.device.sensor.noise = 0.02;
  return setup;
}

Device device_of(const Setup& setup, const Mounting& mounting = {}) {
  auto cell = std::make_shared<SharedForce>();
  const EmulatorOptions options{.counts_per_force = kCounts};
  return Device(ForcePublisher(SimulatedDevice(setup), cell),
                StepSensor(cell, options, mounting, {.counts_per_force = kCounts}));
}

auto loop_of(const Setup& setup, const AnyLaw& law, const Mounting& mounting = {}) {
  return Loop<Device, VirtualClock, PerAxis<AnyLaw>>(
      device_of(setup, mounting), VirtualClock(setup.timing.dt, setup.jitter, setup.seed),
      PerAxis<AnyLaw>(law), SignalChain(setup.device, setup.environment, setup.timing),
      setup.device.axes(), setup.loop);
}

void expect_the_same_run(const char* name, const Setup& setup) {
  const AnyLaw law = designed_law(name, setup);
  const auto direct = simulate_any(setup, law);
  auto loop = loop_of(setup, law);
  const auto trace = loop.make_trace(row_count(setup));
  loop.run(*trace);
  ASSERT_EQ(trace->size(), direct->size());
  double pushed = 0;
  for (std::size_t row = 0; row < trace->size(); ++row) {
    const Sample a = direct->sample(row);
    const Sample b = trace->sample(row);
    ASSERT_EQ(std::memcmp(&a.axis[0], &b.axis[0], sizeof(Axis)), 0) << "row " << row;
    pushed = std::max(pushed, std::abs(b.axis[0].port.f_meas));
  }
  EXPECT_GT(pushed, 5);
  const RdtRow& status_row = loop.device().sensor().state(0);
  EXPECT_EQ(status_row.received, static_cast<std::int64_t>(trace->size()));
  EXPECT_EQ(status_row.lost + status_row.late + status_row.duplicate + status_row.malformed +
                status_row.foreign,
            0);
}

TEST(SensorLoop, TcaOverTheNetworkGivesTheSameBits) { expect_the_same_run("tca", quantised()); }
TEST(SensorLoop, EbacOverTheNetworkGivesTheSameBits) { expect_the_same_run("ebac", quantised()); }

TEST(SensorLoop, ATurnedSensorIsTurnedBack) {
  auto setup = quantised();
  setup.device.kinematics = Linear{.axes = 2};
  setup.hand.path = {Step{.target = 0.04}, Step{.target = 0.01}, Step{}};
  const Mounting turned{.rotation = {0, 0, 1, 1, 0, 0, 0, 1, 0}, .sign = -1};
  const auto direct = simulate_any(setup, designed_law("ebac", setup));
  auto loop = loop_of(setup, designed_law("ebac", setup), turned);
  const auto trace = loop.make_trace(row_count(setup));
  loop.run(*trace);
  ASSERT_EQ(trace->size(), direct->size());
  for (std::size_t row = 0; row < trace->size(); ++row) {
    for (std::size_t i = 0; i < 2; ++i) {
      ASSERT_EQ(trace->sample(row).axis[i].port.f_meas, direct->sample(row).axis[i].port.f_meas);
    }
  }
}

/// The fault of a run in which something happens to the sensor in tick 500, and when it was seen.
struct Found {
  Fault fault{};
  std::int64_t ticks = 0;  // from the trouble on
  double force_after = 0;  // N, commanded in that tick
};

template <class Break>
Found fault_when(Break&& damage) {
  auto setup = quantised();
  setup.loop.limiter = SafetyLimiter(Limits::of(setup.device), setup.device, setup.timing.dt);
  auto loop = loop_of(setup, designed_law("ebac", setup));
  const auto calm = loop.make_trace(500);
  loop.run(*calm);
  EXPECT_EQ(loop.sample().fault, Fault::kNone);
  damage(loop.device().sensor());
  const auto trace = loop.make_trace(1000);
  loop.run(*trace);
  Found found;
  for (std::size_t row = 0; row < trace->size(); ++row) {
    const Sample sample = trace->sample(row);
    if (sample.fault == Fault::kNone) continue;
    found = {sample.fault, static_cast<std::int64_t>(row) + 1, sample.axis[0].port.f_cmd};
    break;
  }
  return found;
}

TEST(SensorLoop, ASilentSensorIsStale) {
  const Found found = fault_when([](StepSensor& s) { s.emulator().set({.silent = true}); });
  EXPECT_EQ(found.fault, Fault::kForceStale);
  EXPECT_NEAR(static_cast<double>(found.ticks), 20.5,
              0.5);  // older than 20 ms, up to the rounding of a sum
  EXPECT_EQ(found.force_after, 0);
}

TEST(SensorLoop, ASaturatedSensorIsSaturatedAtOnce) {
  const Found found = fault_when([](StepSensor& s) { s.emulator().set({.status = 0x80020000}); });
  EXPECT_EQ(found.fault, Fault::kForceSaturated);
  EXPECT_EQ(found.ticks, 1);
  EXPECT_EQ(found.force_after, 0);
}

TEST(SensorLoop, AnErrorOfTheSensorIsNamedSo) {
  const Found found = fault_when([](StepSensor& s) { s.emulator().set({.status = 0x80000004}); });
  EXPECT_EQ(found.fault, Fault::kForceError);
  EXPECT_EQ(found.ticks, 1);
}

TEST(SensorLoop, AClosedSocketIsDisconnected) {
  const Found found = fault_when([](StepSensor& s) { s.client().close(); });
  EXPECT_EQ(found.fault, Fault::kForceDisconnected);
  EXPECT_EQ(found.ticks, 1);
}

/// A device that is enabled at once.
struct Enabled {
  bool on = false;
  Reading exchange(const Command&) noexcept { return {}; }
  void enable() noexcept { on = true; }
  void disable() noexcept { on = false; }
  bool running() const noexcept { return on; }
};

TEST(WithForceSensor, ADeviceRunsOnceItsSensorDoes) {
  auto cell = std::make_shared<SharedForce>();
  WithForceSensor<Enabled, StepSensor> device({}, StepSensor(cell), 0.1);
  device.sensor().emulator().set({.silent = true});
  device.enable();
  for (int k = 0; k < 50; ++k) {
    const Reading reading = device.exchange({.elapsed = 1e-3});
    ASSERT_EQ(reading.force_status, SensorStatus::kGood);
    ASSERT_FALSE(device.running());
  }
  device.sensor().emulator().set({});
  device.exchange({.elapsed = 1e-3});
  EXPECT_TRUE(device.running());
}

TEST(WithForceSensor, ASensorThatNeverComesIsToldAfterAWhile) {
  auto cell = std::make_shared<SharedForce>();
  WithForceSensor<Enabled, StepSensor> device({}, StepSensor(cell), 0.1);
  device.sensor().emulator().set({.silent = true});
  device.enable();
  int ticks = 0;
  while (device.exchange({.elapsed = 1e-3}).force_status == SensorStatus::kGood) ++ticks;
  EXPECT_NEAR(ticks, 99, 1);
}

}  // namespace
}  // namespace ebac::sensor::sensor_loop_test
