// A cable that gives, with and without play, between rotor and lever.
#include "ebac/model/cable.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "ebac/model/stepped_plant.hpp"
#include "rounds.hpp"

namespace ebac::cable_test {
namespace {

constexpr double kTick = 1e-3;
const Hand kNoHand{.mass = 0, .damping = 0, .stiffness = 0};

DeviceModel compliant(double stiffness, double damping = 0) {
  DeviceModel device;
  device.mechanics.damping = 0;
  device.drive.current_lag = 0;
  device.mechanics.cable_stiffness = stiffness;
  device.mechanics.cable_damping = damping;
  return device;
}

/// Position of the rotor, referred to the handle.
double rotor(const DeviceModel& device, const SteppedPlant& plant, std::size_t axis = 0) {
  return plant.motor_angle(axis) / device.capstan.ratio() * device.radius();
}

TEST(Cable, PushesAndNeverPulls) {
  const Cable cable({.cable_stiffness = 1000, .cable_damping = 10, .backlash = 2e-3});
  EXPECT_EQ(cable.flank(0.9e-3, 1), 0);
  EXPECT_EQ(cable.flank(1.5e-3, 0), 1);
  EXPECT_EQ(cable.flank(-1.5e-3, 0), -1);
  EXPECT_EQ(cable.flank(1.5e-3, -0.06), 0);  // leaves faster than the spring can follow
  EXPECT_NEAR(cable.force(1.5e-3, 0.1, 1), 1.5, 1e-12);
  EXPECT_GT(cable.margin(1.5e-3, 0, 1), 0);
  EXPECT_LT(cable.margin(1.5e-3, 0, 0), 0);
  EXPECT_GT(cable.margin(0, 0, 0), 0);
  EXPECT_LT(cable.margin(0, 0, 1), 0);
}

TEST(Cable, WithoutPlayIsPreloaded) {
  const Cable cable({.cable_stiffness = 1000, .cable_damping = 10});
  EXPECT_EQ(cable.flank(0, 0), 1);
  EXPECT_NEAR(cable.force(-1e-3, 0, cable.flank(-1e-3, 0)), -1, 1e-12);
  EXPECT_GT(cable.margin(-1e-3, -1, 1), 0);
}

TEST(SteppedPlant, CableResonatesAtItsFrequency) {
  const DeviceModel device = compliant(2e4);
  SteppedPlant plant(device, kNoHand, 1e-4);
  for (int k = 0; k < 20; ++k) plant.advance({0.5, 0, 0}, 0, kQuanta);
  double before = 0, first = 0, last = 0;
  int crossings = 0;
  for (int k = 0; k < 5000; ++k) {
    plant.advance(Axes::Zero(), 0, kQuanta);
    const double gap = plant.truth(0).x - rotor(device, plant);
    if (before < 0 && gap >= 0) {
      last = 1e-4 * (k - gap / (gap - before));
      if (crossings++ == 0) first = last;
    }
    before = gap;
  }
  const double either = 1 / device.mechanics.handle_mass + 1 / device.reflected_mass();
  const double expected = std::sqrt(2e4 * either) / (2 * std::numbers::pi);
  EXPECT_NEAR((crossings - 1) / (last - first), expected, 2e-5 * expected);
}

/// Hand's spring, cable's spring and two masses: what is not stored was taken.
TEST(SteppedPlant, CableEnergyIsAccountedFor) {
  for (const double damping : {0.0, 5.0}) {
    DeviceModel device = compliant(2e4, damping);
    device.mechanics.coulomb = 0.3;
    device.mechanics.damping = 1;
    const Hand hand{.damping = 0};
    SteppedPlant plant(device, hand, kTick);
    for (int k = 0; k < 500; ++k) plant.advance({std::sin(0.01 * k), 0, 0}, k * kTick, kQuanta);
    for (int k = 500; k < 3000; ++k) plant.advance({0.1, 0, 0}, k * kTick, kQuanta);
    const AxisTruth& now = plant.truth(0);
    const double gap = now.x - rotor(device, plant);
    const double left = hand.stiffness * (0.04 * 0.04 - (0.04 - now.x) * (0.04 - now.x)) -
                        (device.mechanics.handle_mass + hand.mass) * now.v * now.v -
                        2e4 * gap * gap;
    // The rotor is stuck by now; without cable damping the lever still swings on it.
    EXPECT_NEAR(now.energy, 0.5 * left, 1e-6);
  }
}

TEST(SteppedPlant, StiffCableTendsToTheRigidOne) {
  const auto run = [](double stiffness) {
    DeviceModel device;
    device.kinematics = Gimbal{};
    device.mechanics.coulomb = 0.3;
    device.mechanics.cable_stiffness = stiffness;
    device.mechanics.cable_damping = 20;
    SteppedPlant plant(device, Hand{}, kTick);
    for (int k = 0; k < 300; ++k) {
      plant.advance({0.5 * std::sin(0.02 * k), -0.5, 0}, k * kTick, kQuanta);
    }
    return Axes{plant.truth(0).x, plant.truth(1).x, 0};
  };
  const Axes rigid = run(0);
  const double soft = (run(1e5) - rigid).norm();
  const double stiff = (run(1e6) - rigid).norm();
  EXPECT_LT(stiff, 2e-5);
  EXPECT_NEAR(soft / stiff, 10, 2);
}

/// The motor pushes to and fro against a hand that holds the handle: it travels the play, and what
/// the cable and the hand give.
TEST(SteppedPlant, BacklashShowsAtStandstill) {
  DeviceModel device = compliant(1e5, 20);
  device.mechanics.damping = 2;
  device.mechanics.backlash = 4e-4;
  Hand hand;
  hand.path[0] = Step{.target = 0};
  SteppedPlant plant(device, hand, kTick);
  const double force = 3;
  const auto settle = [&](double f) {
    for (int k = 0; k < 2000; ++k) plant.advance({f / device.force(1), 0, 0}, 0, kQuanta);
    return Axes{plant.truth(0).x, rotor(device, plant), 0};
  };
  const Axes pulled = settle(force);
  const Axes pushed = settle(-force);
  EXPECT_NEAR(pushed[0] - pulled[0], 2 * force / hand.stiffness, 1e-8);
  EXPECT_NEAR(pushed[1] - pulled[1] - (pushed[0] - pulled[0]), 4e-4 + 2 * force / 1e5, 1e-8);
}

TEST(SteppedPlant, RotorIsFreeInsideThePlay) {
  DeviceModel device = compliant(1e5);
  device.mechanics.backlash = 2e-3;
  SteppedPlant plant(device, kNoHand, kTick);
  plant.advance({-0.01, 0, 0}, 0, kQuanta);
  for (int k = 0; k < 50; ++k) plant.advance(Axes::Zero(), 0, kQuanta);
  const double v = 0.01 * device.force(1) / device.reflected_mass() * kTick;
  EXPECT_NEAR(rotor(device, plant), v * (kTick / 2 + 50 * kTick), 1e-12);
  EXPECT_EQ(plant.truth(0).x, 0);
}

/// Bouncing between the flanks of an undamped cable conserves energy: the events are where they
/// should be.
TEST(SteppedPlant, UndampedBacklashKeepsItsEnergy) {
  DeviceModel device = compliant(1e5);
  device.mechanics.backlash = 1e-3;
  SteppedPlant plant(device, kNoHand, 1e-4);
  for (int k = 0; k < 100; ++k) plant.advance({-0.5, 0, 0}, 0, kQuanta);
  const double work = -plant.truth(0).energy;  // the motor's
  double before = rotor(device, plant);
  for (int k = 0; k < rounds(10000); ++k) {
    plant.advance(Axes::Zero(), 0, kQuanta);
    const double v = (rotor(device, plant) - before) / 1e-4;
    before = rotor(device, plant);
    const double gap = plant.truth(0).x - before;
    if (std::abs(gap) > 3e-4) continue;  // inside the play the rotor's speed is constant
    const double kinetic =
        0.5 * (device.mechanics.handle_mass * plant.truth(0).v * plant.truth(0).v +
               device.reflected_mass() * v * v);
    ASSERT_NEAR(kinetic, work, 1e-6 * work) << "tick " << k;
  }
  EXPECT_EQ(plant.truth(0).energy, -work);
}

TEST(SteppedPlant, RefusesWhatItCannotResolve) {
  DeviceModel device = compliant(1e8, 1e4);
  device.mechanics.handle_mass = 1e-3;
  EXPECT_THROW(SteppedPlant(device, kNoHand, 0.01), std::invalid_argument);
  EXPECT_NO_THROW(SteppedPlant(compliant(1e8), kNoHand, kTick));
  device = compliant(1e5);
  device.motor.rotor_inertia = 0;
  EXPECT_THROW(SteppedPlant(device, kNoHand, kTick), std::invalid_argument);
}

}  // namespace
}  // namespace ebac::cable_test
