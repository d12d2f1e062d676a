// What a simulated device shows of itself: its encoder, and a force sensor that is not prompt.
#include "ebac/sim/simulated_device.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace ebac::simulated_device_test {
namespace {

TEST(Encoder, UnwrapsAnyTwoNumbers) {
  const Encoder encoder;
  const std::int64_t most = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(encoder.unwrap(most, -5), -1);
  EXPECT_EQ(encoder.unwrap(-most, 5), 1);
}

/// Largest difference between what the sensor shows and the force behind its lag `delay` before [N].
double off_by(double dt, double delay) {
  ebac::Setup setup;
  setup.timing.dt = dt;
  setup.hand.path[0] = Sine{.centre = 0, .frequency = 2};
  setup.device.sensor.delay = delay;
  SimulatedDevice device(setup);
  std::vector<double> true_force;
  double most = 0;
  const auto late = static_cast<std::size_t>(std::lround(delay / dt));
  for (std::size_t k = 0; k < 5 * late; ++k) {
    const Reading reading = device.exchange({.elapsed = k > 0 ? dt : 0.0});
    true_force.push_back(device.state(0).f_sensor);
    if (k >= late) most = std::max(most, std::abs(reading.force[0] - true_force[k - late]));
  }
  return most;
}

TEST(ForceSensor, IsAsLateAsDeclaredAtAnySampleTime) {
  EXPECT_LT(off_by(1e-3, 0.02), 1e-9);
  EXPECT_LT(off_by(1e-4, 0.02), 1e-9);
  EXPECT_LT(off_by(1e-5, 0.02), 1e-9);
}

TEST(ForceSensor, ThatIsDisconnectedSaysSoWhateverItShowedLast) {
  ebac::Setup setup;
  setup.device.sensor.range = 0.05;
  setup.device.sensor.stops_at = 0.05;
  setup.device.sensor.disconnects = true;
  SimulatedDevice device(setup);
  Reading reading = device.exchange({});
  for (int k = 0; k < 40; ++k) reading = device.exchange({.elapsed = 1e-3});
  EXPECT_EQ(reading.force_status, SensorStatus::kSaturated);
  for (int k = 0; k < 20; ++k) reading = device.exchange({.elapsed = 1e-3});
  EXPECT_EQ(reading.force_status, SensorStatus::kDisconnected);
}

/// Force of the motor, over that of its current, tick by tick: a hand pulls it slowly over many turns of the ripple.
std::vector<double> motor_force(const DeviceModel& device, double current,
                                std::vector<double>* angles = nullptr) {
  ebac::Setup setup;
  setup.device = device;
  setup.device.drive.current_lag = 0;
  setup.hand.stiffness = 1e4;
  setup.hand.damping = 50;
  setup.hand.path[0] = Sine{.centre = 0, .amplitude = 0.02, .frequency = 0.1};
  setup.timing.delay = 0;
  SimulatedDevice simulated(setup);
  std::vector<double> forces;
  for (int k = 0; k < 2000; ++k) {
    Command command{.elapsed = 1e-3};
    command.current[0] = current;
    const double x = simulated.state(0).x;
    const Reading reading = simulated.exchange(command);
    EXPECT_EQ(reading.current_applied[0], current) << "a drive does not show its errors";
    forces.push_back(simulated.state(0).f_motor / device.force(1));
    if (angles != nullptr) angles->push_back(x * device.capstan.ratio() / device.radius());
  }
  return forces;
}

/// Amplitude and largest error of the wave of `waves` periods a turn in `shares`.
std::pair<double, double> wave_of(const std::vector<double>& shares,
                                  const std::vector<double>& angles, int waves) {
  Eigen::MatrixX2d waving(static_cast<Eigen::Index>(shares.size()), 2);
  Eigen::VectorXd off(waving.rows());
  for (Eigen::Index k = 0; k < off.size(); ++k) {
    const double at = waves * angles[static_cast<std::size_t>(k)];
    waving.row(k) << std::sin(at), std::cos(at);
    off[k] = shares[static_cast<std::size_t>(k)];
  }
  const Eigen::Vector2d fit = waving.colPivHouseholderQr().solve(off);
  return {fit.norm(), (waving * fit - off).cwiseAbs().maxCoeff()};
}

TEST(Motor, RipplesWithItsTorque) {
  DeviceModel device;
  device.motor.ripple = 0.02;
  device.motor.waves = 13;
  for (const double current : {0.5, -1.0}) {
    std::vector<double> angles;
    std::vector<double> shares = motor_force(device, current, &angles);
    for (double& share : shares) share = share / current - 1;
    const auto [amplitude, error] = wave_of(shares, angles, 13);
    EXPECT_NEAR(amplitude, 0.02, 1e-9);
    EXPECT_LT(error, 1e-9);
  }
  for (const double force : motor_force(device, 0.0)) ASSERT_EQ(force, 0);
}

TEST(Motor, CogsWithoutCurrent) {
  DeviceModel device;
  device.motor.cogging = 0.01 * device.motor.torque_constant;
  const std::vector<double> forces = motor_force(device, 0.0);
  EXPECT_NEAR(*std::ranges::max_element(forces), 0.01, 1e-4);
  EXPECT_NEAR(*std::ranges::min_element(forces), -0.01, 1e-4);
}

TEST(Drive, HasAnOffsetAndNoise) {
  DeviceModel device;
  device.drive.current_offset = 0.02;
  for (const double force : motor_force(device, 0.5)) ASSERT_NEAR(force, 0.52, 1e-12);
  device.drive.current_noise = 0.01;
  double sum = 0, squares = 0;
  const std::vector<double> forces = motor_force(device, 0.5);
  for (const double force : forces) {
    sum += force - 0.52;
    squares += (force - 0.52) * (force - 0.52);
  }
  const auto n = static_cast<double>(forces.size());
  EXPECT_NEAR(sum / n, 0, 0.01 * 4 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 0.01, 0.01 * 4 / std::sqrt(2 * n));
}

}  // namespace
}  // namespace ebac::simulated_device_test
