// Dry friction in the stepped plant: break-away, sliding, sticking.
#include "ebac/model/friction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ebac/model/stepped_plant.hpp"

namespace ebac::friction_test {
namespace {

constexpr double kTick = 1e-3;

TEST(Friction, FallsFromBreakawayToCoulomb) {
  const Friction friction({.coulomb = 0.5, .breakaway = 1.25, .stribeck_speed = 0.01});
  EXPECT_EQ(friction.sliding(0), 1.25);
  EXPECT_NEAR(friction.sliding(0.01), 0.5 + 0.75 / std::exp(1), 1e-15);
  EXPECT_NEAR(friction.sliding(-0.01), friction.sliding(0.01), 0);
  EXPECT_EQ(friction.sliding(1), 0.5);
}

TEST(Friction, IsCoulombsWithoutBreakaway) {
  const Friction friction({.coulomb = 0.5});
  EXPECT_EQ(friction.breakaway, 0.5);
  EXPECT_EQ(friction.sliding(0), 0.5);
  EXPECT_FALSE(Friction(Mechanics{}).present());
}

DeviceModel stribeck() {
  DeviceModel device;
  device.drive.current_lag = 0;
  device.mechanics.coulomb = 0.5;
  device.mechanics.breakaway = 1.25;
  return device;
}

const Hand kNoHand{.mass = 0, .damping = 0, .stiffness = 0};

TEST(SteppedPlant, BreaksAwayAtTheBreakawayForce) {
  const DeviceModel device = stribeck();
  SteppedPlant plant(device, kNoHand, kTick);
  double force = 0;
  for (int k = 0; plant.truth(0).x == 0 && k < 2000; ++k) {
    force = 0.001 * k;
    plant.advance({-force / device.force(1), 0, 0}, k * kTick, kQuanta);
  }
  EXPECT_NEAR(force, 1.25, 0.0011);
}

TEST(SteppedPlant, SlidesFastAgainstCoulombFrictionAlone) {
  const DeviceModel device = stribeck();
  SteppedPlant plant(device, kNoHand, kTick);
  for (int k = 0; k < 4000; ++k) plant.advance({-3 / device.force(1), 0, 0}, k * kTick, kQuanta);
  EXPECT_NEAR(plant.truth(0).v, (3 - 0.5) / device.mechanics.damping, 1e-9);
}

/// A spring drawn slowly sticks and slips; what static friction holds never exceeds the break-away
/// force.
TEST(SteppedPlant, SticksAndSlips) {
  const DeviceModel device = stribeck();
  Hand hand{.damping = 0};
  hand.path[0] = Recorded({0, 4}, {0, 0.04});
  SteppedPlant plant(device, hand, kTick);
  int slips = 0;
  double last = 0;
  double x = 0;
  for (int k = 0; k < 4000; ++k) {
    plant.advance(Axes::Zero(), k * kTick, kQuanta);
    const AxisTruth& now = plant.truth(0);
    if (now.v == 0 && last == 0) {
      ASSERT_EQ(now.x, x);  // no creeping
      ASSERT_LE(std::abs(now.f_hand), 1.25 + 1e-9);
    }
    if (now.v > 0 && last == 0) ++slips;
    last = now.v;
    x = now.x;
  }
  EXPECT_GE(slips, 5);
}

TEST(SteppedPlant, OneJointSlidesWhileTheOtherIsStuck) {
  DeviceModel device;
  device.kinematics = Gimbal{};
  device.mechanics.coulomb = 1;
  SteppedPlant plant(device, kNoHand, kTick);
  for (int k = 0; k < 200; ++k) {
    plant.advance({-3 / device.force(1), 0.9 / device.force(1), 0}, k * kTick, kQuanta);
    ASSERT_EQ(plant.motor_angle(1), 0);
  }
  EXPECT_GT(plant.truth(0).x, 0.01);
}

TEST(SteppedPlant, NotANumberInGivesNotANumberOut) {
  const DeviceModel device = stribeck();
  SteppedPlant plant(device, Hand{}, kTick);
  plant.advance({std::nan(""), 0, 0}, 0, kQuanta);
  plant.advance(Axes::Zero(), kTick, kQuanta);
  EXPECT_TRUE(std::isnan(plant.motor_angle(0)));
}

}  // namespace
}  // namespace ebac::friction_test
