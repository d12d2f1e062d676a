// The two plants on the same device: each is the test of the other.
#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "ebac/model/exact_plant.hpp"
#include "ebac/model/noise.hpp"
#include "ebac/model/stepped_plant.hpp"
#include "rounds.hpp"

namespace ebac::plant_agreement_test {
namespace {

constexpr double kTick = 1e-3;
/// With a lag of a microsecond a tick takes steps by the thousand, and 0.4 s show what it changes.
constexpr int kShort = 400;

struct Agreement {
  std::string_view name;
  void (*change)(DeviceModel&, Hand&);
  bool jitter = false;
  int ticks = rounds(2000);
};

void PrintTo(const Agreement& a, std::ostream* out) { *out << a.name; }

class BothPlants : public testing::TestWithParam<Agreement> {};

/// Reached with the defaults: 2e-10 m, 3e-5 N at the sensor. With friction 3e-9 m, of which most is
/// the quantum of time in which the exact plant finds an event.
TEST_P(BothPlants, Agree) {
  DeviceModel device;
  Hand hand;
  GetParam().change(device, hand);
  ExactPlant exact(device, hand, kTick);
  SteppedPlant stepped(device, hand, kTick);
  Noise random(1);
  Axes current = Axes::Zero();
  double t = 0;
  for (int k = 0; k < GetParam().ticks; ++k) {
    for (int i = 0; k % 7 == 0 && i < kMaxAxes; ++i) current[i] = 0.8 * random.symmetric();
    const auto quanta = GetParam().jitter
                            ? static_cast<std::int64_t>(kQuanta * (1 + 0.3 * random.symmetric()))
                            : kQuanta;
    exact.advance(current, t, quanta);
    stepped.advance(current, t, quanta);
    t += kTick * static_cast<double>(quanta) / kQuanta;
    for (std::size_t i = 0; i < static_cast<std::size_t>(device.axes()); ++i) {
      const AxisTruth& a = exact.truth(i);
      const AxisTruth& b = stepped.truth(i);
      ASSERT_NEAR(a.x, b.x, 1e-8) << "tick " << k;
      ASSERT_NEAR(a.v, b.v, 2e-7) << "tick " << k;
      ASSERT_NEAR(a.f_motor, b.f_motor, 1e-10) << "tick " << k;
      ASSERT_NEAR(a.f_hand, b.f_hand, 1e-5) << "tick " << k;
      ASSERT_NEAR(a.f_sensor, b.f_sensor, 1e-4) << "tick " << k;
      ASSERT_NEAR(a.energy, b.energy, 2e-7) << "tick " << k;
      ASSERT_NEAR(exact.motor_angle(i), stepped.motor_angle(i), 3e-6) << "tick " << k;
    }
  }
}

constexpr Agreement kAgreements[] = {
    {"Default", [](DeviceModel&, Hand&) {}},
    {"Jitter", [](DeviceModel&, Hand&) {}, true},
    {"Gravity", [](DeviceModel& d, Hand&) { d.mechanics.gravity = 9.81; }},
    {"NoCurrentLag", [](DeviceModel& d, Hand&) { d.drive.current_lag = 0; }},
    {"TinyCurrentLag", [](DeviceModel& d, Hand&) { d.drive.current_lag = 1e-6; }, false, kShort},
    {"NoSensorLag", [](DeviceModel& d, Hand&) { d.sensor.lag = 0; }},
    {"TinySensorLag", [](DeviceModel& d, Hand&) { d.sensor.lag = 1e-6; }, false, kShort},
    {"NoLags", [](DeviceModel& d, Hand&) { d.drive.current_lag = d.sensor.lag = 0; }},
    {"SlowLags",
     [](DeviceModel& d, Hand&) {
       d.drive.current_lag = 0.1;
       d.sensor.lag = 0.05;
     }},
    {"Release", [](DeviceModel&, Hand& h) { h.release_at = 1; }},
    {"Tremor", [](DeviceModel&, Hand& h) { h.tremor_amplitude = 1e-3; }},
    {"Coulomb", [](DeviceModel& d, Hand&) { d.mechanics.coulomb = 0.3; }},
    {"CoulombWithoutLags",
     [](DeviceModel& d, Hand&) {
       d.mechanics.coulomb = 1.5;
       d.drive.current_lag = d.sensor.lag = 0;
     }},
    {"MostlyStuck", [](DeviceModel& d, Hand&) { d.mechanics.coulomb = 6; }, true},
    {"CoulombTremorGravityRelease",
     [](DeviceModel& d, Hand& h) {
       d.mechanics.coulomb = 0.5;
       d.mechanics.gravity = 9.81;
       h.tremor_amplitude = 1e-3;
       h.release_at = 1;
     },
     true},
    {"ThreeAxes",
     [](DeviceModel& d, Hand& h) {
       d.kinematics = Linear{.axes = 3, .radius = 0.07};
       d.mechanics.coulomb = 0.5;
       h.path[1] = Sine{};
       h.path[2] = MinimumJerk{};
     }},
};

INSTANTIATE_TEST_SUITE_P(Cases, BothPlants, testing::ValuesIn(kAgreements),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace ebac::plant_agreement_test
