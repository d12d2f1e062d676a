#include "ebac/sim/press.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "designed_law.hpp"
#include "ebac/sim/any_law.hpp"

namespace ebac::press_test {
namespace {

Setup pressing() {
  Setup setup;
  setup.seconds = 1.5;
  return setup;
}

Press one(const Setup& setup, const AnyLaw& law, double goal) {
  SweepProgress progress;
  return press_any({&setup}, {&law}, {goal}, 1, RunLimits{}, progress).front();
}

TEST(EffortWatch, MeasuresWhatItSees) {
  const SimulatedDevice device(pressing());
  EffortWatch watch(1000, 0.5);
  Sample s{};
  s.axes = 1;
  for (int i = 0; i < 1000; ++i) {
    s.t = 1e-3 * i;
    s.axis[0].port.dt = 1e-3;
    s.axis[0].port.f_cmd = i % 2 == 0 ? 1 : -1;  // changes by 2 N every tick
    s.axis[0].port.f_applied = i == 10 ? -7 : 0;
    s.axis[0].joint.current = i == 20 ? -0.25 : 0.1;
    watch(s, device);
  }
  const PressEffort effort = watch.effort();
  EXPECT_DOUBLE_EQ(effort.most_force, 7);
  EXPECT_DOUBLE_EQ(effort.most_current, 0.25);
  EXPECT_NEAR(effort.noise, std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(effort.lateness, 0.5 * 0.999 / 2, 1e-3);  // 0.5 m away: the mean of t over the run
}

TEST(EffortWatch, ARunTooShortHasNoNoise) {
  const EffortWatch watch(1000, 0);
  EXPECT_TRUE(std::isnan(watch.effort().noise));
}

TEST(Press, IsTheRunOfASweepAndMore) {
  const auto setup = pressing();
  const AnyLaw law = designed_law("ebac", setup);
  const Press found = one(setup, law, 1.165e-3);
  ContactRecorder recorder;
  const std::atomic<bool> cancelled = false;
  const Outcome same = measure_run(setup, law, RunLimits{}, recorder, cancelled);
  EXPECT_EQ(found.outcome.contact.rest, same.contact.rest);
  EXPECT_EQ(found.outcome.contact.least_energy, same.contact.least_energy);
  EXPECT_GT(found.effort.most_force, 10);
  EXPECT_LE(found.effort.most_force, setup.device.peak_force() + 1e-9);
  EXPECT_NEAR(found.effort.most_current, setup.device.drive.peak_current(setup.device.motor), 4);
}

TEST(Press, AGoalFartherAwayIsLater) {
  const auto setup = pressing();
  const AnyLaw law = designed_law("tca", setup);
  EXPECT_LT(one(setup, law, 0.0).effort.lateness, one(setup, law, 0.1).effort.lateness);
}

}  // namespace
}  // namespace ebac::press_test
