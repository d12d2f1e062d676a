// The general integrator against conservation laws: the gimbal, its energy, its order.
#include "ebac/model/stepped_plant.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "rounds.hpp"

namespace ebac::stepped_plant_test {
namespace {

constexpr double kTick = 1e-3;

DeviceModel gimbal() {
  DeviceModel device;
  device.kinematics = Gimbal{};
  return device;
}

DeviceModel frictionless_gimbal() {
  DeviceModel device = gimbal();
  device.mechanics.damping = 0;
  device.drive.current_lag = 0;
  return device;
}

/// Joint angles and rates behind the truth.
Axes joints(const DeviceModel& device, const SteppedPlant& plant) {
  Axes q = Axes::Zero();
  for (int i = 0; i < device.axes(); ++i) {
    q[i] = plant.motor_angle(static_cast<std::size_t>(i)) / device.capstan.ratio();
  }
  return q;
}

Axes rates(const DeviceModel& device, const SteppedPlant& plant) {
  Jacobian j = jacobian(device.kinematics, joints(device, plant));
  j(2, 2) = 1;
  return j.inverse() * Axes{plant.truth(0).v, plant.truth(1).v, 0};
}

double kinetic(const DeviceModel& device, const Hand& hand, const SteppedPlant& plant) {
  const Axes q = joints(device, plant);
  const Axes dq = rates(device, plant);
  const Pose at = pose(device.kinematics, q, dq);
  const double rotor = device.reflected_mass() * device.radius() * device.radius();
  return 0.5 * (device.mechanics.handle_mass * at.inertia.dot(dq.cwiseProduct(dq)) +
                rotor * dq.squaredNorm() + hand.mass * (at.j * dq).squaredNorm());
}

double kick_and_error(double tick) {
  DeviceModel device = gimbal();
  device.drive.current_lag = device.sensor.lag = 0;
  const Axes current{-0.6, 0.4, 0};
  const auto at_end = [&](double h) {
    Hand hand;
    hand.path[1] = Step{.target = -0.03};
    SteppedPlant plant(device, hand, h);
    for (int k = 0; k < std::lround(0.08 / h); ++k) plant.advance(current, k * h, kQuanta);
    return Axes{plant.truth(0).x, plant.truth(1).x, 0};
  };
  return (at_end(tick) - at_end(6.25e-5)).norm();
}

/// With no lag to resolve, each of these ticks is one step.
TEST(SteppedPlant, ConvergesWithFourthOrder) {
  const double coarse = kick_and_error(2e-3);
  const double fine = kick_and_error(1e-3);
  EXPECT_LT(coarse, 1e-8);
  EXPECT_GT(std::log2(coarse / fine), 3.8);
  EXPECT_LT(std::log2(coarse / fine), 4.5);
}

TEST(SteppedPlant, GimbalPendulumKeepsItsEnergy) {
  DeviceModel device = frictionless_gimbal();
  device.mechanics.gravity = -9.81;  // upright is stable
  const Hand hand{.damping = 0, .stiffness = 0};
  SteppedPlant plant(device, hand, kTick);
  for (int k = 0; k < 50; ++k) plant.advance({-0.6, 0.4, 0}, k * kTick, kQuanta);
  const auto energy = [&] {
    const double height = Gimbal{}.height(joints(device, plant));
    return kinetic(device, hand, plant) +
           device.mechanics.handle_mass * device.mechanics.gravity * (height - device.radius());
  };
  const double before = energy();
  EXPECT_GT(before, 0.04);
  double farthest = 0;
  for (int k = 50; k < 50 + rounds(10000); ++k) {
    plant.advance(Axes::Zero(), k * kTick, kQuanta);
    farthest = std::max(farthest, joints(device, plant).cwiseAbs().maxCoeff());
    ASSERT_NEAR(energy(), before, 1e-8 * before) << "tick " << k;
  }
  EXPECT_GT(farthest, 0.5);  // far enough for every Coriolis term to count
}

/// A free point on a sphere runs along a great circle at constant speed.
TEST(SteppedPlant, FreeGimbalRunsAlongAGreatCircle) {
  DeviceModel device = frictionless_gimbal();
  device.motor.rotor_inertia = 0;
  SteppedPlant plant(device, {.mass = 0, .damping = 0, .stiffness = 0}, kTick);
  for (int k = 0; k < 10; ++k) plant.advance({-0.3, 0.2, 0}, k * kTick, kQuanta);
  const auto momentum = [&] {
    const Axes q = joints(device, plant);
    const Axes p{plant.truth(0).x, plant.truth(1).x, Gimbal{}.height(q)};
    Axes v{plant.truth(0).v, plant.truth(1).v, 0};
    v[2] = -(p[0] * v[0] + p[1] * v[1]) / p[2];  // along the sphere
    return Axes(p.cross(v));
  };
  const Axes before = momentum();
  for (int k = 10; k < 150; ++k) {
    plant.advance(Axes::Zero(), k * kTick, kQuanta);
    ASSERT_LT((momentum() - before).norm(), 1e-9 * before.norm()) << "tick " << k;
  }
  EXPECT_GT(joints(device, plant).head(2).cwiseAbs().minCoeff(), 0.25);
}

/// A free point in space runs along a straight line at constant speed, whatever the joints do.
TEST(SteppedPlant, FreeSlidingGimbalRunsStraight) {
  DeviceModel device = frictionless_gimbal();
  device.kinematics = SlidingGimbal{.slide_radius = 0.06};
  device.motor.rotor_inertia = 0;
  SteppedPlant plant(device, {.mass = 0, .damping = 0, .stiffness = 0}, kTick);
  for (int k = 0; k < 10; ++k) plant.advance({-0.3, 0.2, 0.15}, k * kTick, kQuanta);
  const auto all = [&](double AxisTruth::* member) {
    return Axes{plant.truth(0).*member, plant.truth(1).*member, plant.truth(2).*member};
  };
  const Axes from = all(&AxisTruth::x), v = all(&AxisTruth::v);
  EXPECT_GT(v.cwiseAbs().minCoeff(), 0.05);
  for (int k = 0; k < 100; ++k) {
    plant.advance(Axes::Zero(), (10 + k) * kTick, kQuanta);
    const Axes expected = from + (k + 1) * kTick * v;
    ASSERT_LT((all(&AxisTruth::x) - expected).norm(), 1e-9) << "tick " << k;
  }
}

TEST(SteppedPlant, GimbalIsLinearForSmallAngles) {
  DeviceModel straight;
  straight.kinematics = Linear{.axes = 2};
  const auto difference = [&](double share) {
    Hand hand;
    hand.path = {Step{.target = 0.04 * share}, Step{.target = -0.02 * share}, Step{.target = 0}};
    SteppedPlant a(gimbal(), hand, kTick);
    SteppedPlant b(straight, hand, kTick);
    double most = 0;
    for (int k = 0; k < 500; ++k) {
      const Axes current = share * Axes{0.3, std::sin(0.02 * k), 0};
      a.advance(current, k * kTick, kQuanta);
      b.advance(current, k * kTick, kQuanta);
      for (std::size_t i = 0; i < 2; ++i)
        most = std::max(most, std::abs(a.truth(i).x - b.truth(i).x));
    }
    return most / share;
  };
  EXPECT_LT(difference(0.01), 2e-6);
  EXPECT_NEAR(difference(0.1) / difference(0.01), 100, 2);  // the square of the angle
}

/// Energy taken = work of hand and weight - kinetic energy, with everything the gimbal has.
TEST(SteppedPlant, GimbalEnergyIsTheWorkOfTheHandLessTheKineticEnergy) {
  DeviceModel device = gimbal();
  device.mechanics.gravity = 9.81;
  device.mechanics.coulomb = 0.4;
  device.mechanics.breakaway = 0.8;
  Hand hand{.damping = 0};
  hand.path[1] = Step{.target = -0.02};
  const Axes target{0.04, -0.02, 0};
  SteppedPlant plant(device, hand, kTick);
  for (int k = 0; k < 2000; ++k) {
    plant.advance({std::sin(0.01 * k), 0.5 * std::cos(0.03 * k), 0}, k * kTick, kQuanta);
    const Axes x{plant.truth(0).x, plant.truth(1).x, 0};
    const double spring =
        0.5 * hand.stiffness * (target.squaredNorm() - (target - x).squaredNorm());
    const double fallen = device.radius() - Gimbal{}.height(joints(device, plant));
    const double work = spring + device.mechanics.handle_mass * device.mechanics.gravity * fallen;
    ASSERT_NEAR(plant.truth(0).energy + plant.truth(1).energy, work - kinetic(device, hand, plant),
                2e-7)
        << "tick " << k;
  }
}

TEST(SteppedPlant, UnusedAxesStayEmpty) {
  Hand hand;
  hand.path[2] = Step{};
  hand.tremor_amplitude = 1e-3;
  SteppedPlant plant(gimbal(), hand, kTick);
  for (int k = 0; k < 100; ++k) plant.advance({0.1, 0.1, 0.1}, k * kTick, kQuanta);
  EXPECT_EQ(plant.truth(2).x, 0);
  EXPECT_EQ(plant.truth(2).f_hand, 0);
  EXPECT_EQ(plant.motor_angle(2), 0);
}

}  // namespace
}  // namespace ebac::stepped_plant_test
