// The closed-form axis against mathematics: composition, energy, friction, analytic motions.
#include "ebac/model/exact_plant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace ebac::exact_plant_test {
namespace {

constexpr double kTick = 1e-3;

AxisParameters bare(double coulomb = 0) {  // no hand, no lags
  return {.coulomb = coulomb,
          .current_lag = 0,
          .sensor_lag = 0,
          .hand_mass = 0,
          .hand_damping = 0,
          .hand_stiffness = 0};
}

/// A motor force that pushes and pulls, in whole seconds the same on every run.
double push(int k) { return 8 * std::sin(0.05 * k) + (k / 40 % 2 == 0 ? 3 : -3); }

TEST(ExactAxis, SlidesUnderConstantForceAsTheFormulaSays) {
  const AxisParameters p = bare();
  ExactAxis axis(p, kTick);
  const double f = -5;  // resists +x, so this pushes towards +x
  for (int k = 1; k <= 500; ++k) {
    axis.advance(f, 0, 0, kQuanta);
    const double t = k * kTick;
    const double tau = p.device_mass / p.device_damping;
    const double v = -f / p.device_damping * (1 - std::exp(-t / tau));
    ASSERT_NEAR(axis.truth().v, v, 1e-12);
    ASSERT_NEAR(axis.truth().x, -f / p.device_damping * t - tau * v, 1e-12);
  }
}

TEST(ExactAxis, DecaysFreely) {
  const AxisParameters p = bare();
  ExactAxis axis(p, kTick);
  for (int k = 0; k < 50; ++k) axis.advance(-5, 0, 0, kQuanta);
  const double v0 = axis.truth().v;
  for (int k = 0; k < 300; ++k) axis.advance(0, 0, 0, kQuanta);
  EXPECT_NEAR(axis.truth().v, v0 * std::exp(-0.3 * p.device_damping / p.device_mass), 1e-12);
}

TEST(ExactAxis, CoulombFrictionStopsAMassWhereTheFormulaSays) {
  AxisParameters p = bare(0.5);
  p.device_damping = 0;
  ExactAxis axis(p, kTick);
  for (int k = 0; k < 20; ++k) axis.advance(-5, 0, 0, kQuanta);
  const double v0 = axis.truth().v;
  const double x0 = axis.truth().x;
  EXPECT_NEAR(v0, (5 - 0.5) / p.device_mass * 0.02, 1e-12);
  for (int k = 0; k < 500; ++k) axis.advance(0, 0, 0, kQuanta);
  EXPECT_EQ(axis.truth().v, 0);
  EXPECT_NEAR(axis.truth().x - x0, 0.5 * p.device_mass * v0 * v0 / 0.5, 1e-9);
}

TEST(ExactAxis, FollowsTheLagsOfDriveAndSensor) {
  const AxisParameters p{.coulomb = 50};  // held fast
  ExactAxis axis(p, kTick);
  for (int k = 0; k < 3; ++k) axis.advance(7, 0.01, 0, kQuanta);
  EXPECT_NEAR(axis.truth().f_motor, 7 * (1 - std::exp(-3e-3 / p.current_lag)), 1e-12);
  EXPECT_NEAR(axis.truth().f_hand, 300 * 0.01, 1e-10);
  EXPECT_NEAR(axis.truth().f_sensor, 3 * (1 - std::exp(-3e-3 / p.sensor_lag)), 1e-10);
}

class Splitting : public testing::TestWithParam<double> {};

TEST_P(Splitting, ATickInPartsGivesTheSameState) {
  const AxisParameters p{.coulomb = GetParam()};
  ExactAxis whole(p, kTick);
  ExactAxis parts(p, kTick);
  const double rate = 0.02;
  // An event is found to a quantum: with friction the two may differ by a nanosecond of
  // acceleration.
  const double close = GetParam() > 0 ? 1e-7 : 1e-11;
  for (int k = 0; k < 1000; ++k) {
    const double target = rate * kTick * k;
    whole.advance(push(k), target, rate, kQuanta);
    std::int64_t done = 0;
    for (const std::int64_t part : {kQuanta / 3, std::int64_t{1}, kQuanta / 2}) {
      parts.advance(push(k), target + rate * kTick * static_cast<double>(done) / kQuanta, rate,
                    part);
      done += part;
    }
    parts.advance(push(k), target + rate * kTick * static_cast<double>(done) / kQuanta, rate,
                  kQuanta - done);
    ASSERT_NEAR(whole.truth().x, parts.truth().x, close) << "tick " << k;
    ASSERT_NEAR(whole.truth().v, parts.truth().v, 10 * close) << "tick " << k;
    ASSERT_NEAR(whole.truth().f_sensor, parts.truth().f_sensor, 100 * close) << "tick " << k;
    ASSERT_NEAR(whole.truth().energy, parts.truth().energy, close) << "tick " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Coulomb, Splitting, testing::Values(0.0, 0.3, 2.0));

class Energy : public testing::TestWithParam<double> {};

/// With a hand that is a spring, its work is a difference of potentials: the account must close to
/// the bit of rounding.
TEST_P(Energy, IsTheWorkOfHandAndWeightLessTheKineticEnergy) {
  const AxisParameters p{.coulomb = GetParam(), .weight = 1.2, .hand_damping = 0};
  ExactAxis axis(p, kTick);
  const double target = 0.03;
  for (int k = 0; k < 2000; ++k) {
    axis.advance(push(k), target, 0, kQuanta);
    const AxisTruth& now = axis.truth();
    const double spring =
        0.5 * p.hand_stiffness * (target * target - (target - now.x) * (target - now.x));
    const double kinetic = 0.5 * (p.device_mass + p.hand_mass) * now.v * now.v;
    ASSERT_NEAR(now.energy, spring + p.weight * now.x - kinetic, 1e-9) << "tick " << k;
  }
}

/// With damper and moving target the work of the hand is an integral, here Simpson's over a fine
/// grid.
TEST_P(Energy, IsTheIntegratedWorkOfTheHandLessTheKineticEnergyOfTheDevice) {
  const AxisParameters p{.coulomb = GetParam()};
  ExactAxis axis(p, 1e-5);
  double work = 0;
  for (int k = 0; k < 20000; ++k) {
    const double rate = 0.2 * std::cos(2e-4 * k);
    double power[3];
    for (int half = 0; half < 3; ++half) {
      if (half > 0) {
        const double target = 1e-3 * std::sin(2e-4 * k) + (half - 1) * 0.5e-5 * rate;
        axis.advance(push(k / 100), target, rate, kQuanta / 2);
      }
      power[half] = axis.truth().f_hand * axis.truth().v;
    }
    work += 1e-5 / 6 * (power[0] + 4 * power[1] + power[2]);
  }
  const double kinetic = 0.5 * p.device_mass * axis.truth().v * axis.truth().v;
  EXPECT_NEAR(axis.truth().energy, work - kinetic, 2e-5);
}

INSTANTIATE_TEST_SUITE_P(Coulomb, Energy, testing::Values(0.0, 0.3, 2.0));

TEST(ExactAxis, StaticFrictionHoldsWithoutCreeping) {
  ExactAxis axis({.coulomb = 1.0}, kTick);
  for (int k = 0; k < 300; ++k) axis.advance(-6, 0, 0, kQuanta);
  for (int k = 0; k < 2000; ++k) axis.advance(0, 0, 0, kQuanta);
  const double x = axis.truth().x;
  EXPECT_NE(x, 0);
  EXPECT_EQ(axis.truth().v, 0);
  for (int k = 0; k < 2000; ++k) {
    axis.advance(-300 * x + 0.9 * std::sin(0.1 * k), 0, 0, kQuanta);
    ASSERT_EQ(axis.truth().x, x);
    ASSERT_EQ(axis.truth().v, 0);
  }
}

TEST(ExactAxis, BreaksAwayWhenTheForceExceedsFriction) {
  const AxisParameters p = bare(1.0);
  ExactAxis axis(p, kTick);
  axis.advance(-0.999999, 0, 0, kQuanta);
  EXPECT_EQ(axis.truth().x, 0);
  axis.advance(-1.000001, 0, 0, kQuanta);
  EXPECT_GT(axis.truth().x, 0);
}

/// The force turns from braking to driving while the axis still moves: it must not be taken for
/// stopped.
TEST(ExactAxis, SlowingDownIsNotStopping) {
  AxisParameters p = bare(0.3);
  p.current_lag = 3e-4;
  ExactAxis axis(p, kTick);
  for (int k = 0; k < 100; ++k) axis.advance(-5, 0, 0, kQuanta);
  axis.advance(5, 0, 0, kQuanta);
  const double before = axis.truth().v;
  axis.advance(-5, 0, 0, kQuanta);
  EXPECT_GT(before, 0.5);
  EXPECT_GT(axis.truth().v, 0.9 * before);
}

TEST(ExactPlant, RefusesWhatItCannotDo) {
  DeviceModel device;
  EXPECT_TRUE(ExactPlant::covers(device));
  device.mechanics.breakaway = 1;
  EXPECT_THROW(ExactPlant(device, Hand{}, kTick), std::invalid_argument);
  device = {};
  device.mechanics.cable_stiffness = 1e5;
  EXPECT_FALSE(ExactPlant::covers(device));
  device = {};
  device.kinematics = Gimbal{};
  EXPECT_FALSE(ExactPlant::covers(device));
}

TEST(ExactPlant, HandLetsGo) {
  const Hand hand{.release_at = 0.2};
  ExactPlant plant(DeviceModel{}, hand, kTick);
  for (int k = 0; k < 200; ++k) plant.advance(Axes::Zero(), k * kTick, kQuanta);
  const AxisTruth held = plant.truth(0);
  EXPECT_NE(held.f_hand, 0);
  for (int k = 200; k < 300; ++k) plant.advance(Axes::Zero(), k * kTick, kQuanta);
  EXPECT_EQ(plant.truth(0).f_hand, 0);
  const DeviceModel device;
  const double slope = device.mechanics.damping / device.mass();
  EXPECT_NEAR(plant.truth(0).v, held.v * std::exp(-0.1 * slope), 1e-12);
}

TEST(ExactPlant, TimeBelowAQuantumMovesNothing) {
  Hand hand;
  hand.path[0] = MinimumJerk{};
  ExactPlant plant(DeviceModel{}, hand, kTick);
  plant.advance(Axes::Zero(), 0.2, kQuanta);
  const AxisTruth before = plant.truth(0);
  plant.advance(Axes::Zero(), 0.2 + kTick, 0);
  EXPECT_EQ(plant.truth(0).x, before.x);
  EXPECT_EQ(plant.truth(0).v, before.v);
  EXPECT_EQ(plant.truth(0).energy, before.energy);
}

}  // namespace
}  // namespace ebac::exact_plant_test
