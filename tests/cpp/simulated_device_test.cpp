// What a simulated device shows of itself: its encoder, and a force sensor that is not prompt.
#include "ebac/sim/simulated_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
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

}  // namespace
}  // namespace ebac::simulated_device_test
