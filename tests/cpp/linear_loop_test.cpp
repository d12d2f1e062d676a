// The sampled linear loop against the simulation it stands for, and against formulas.
#include "ebac/sim/linear_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "ebac/control/direct.hpp"
#include "ebac/control/law_type.hpp"
#include "ebac/sim/any_law.hpp"

namespace ebac::linear_loop_test {
namespace {

const Hand kNoHand{.mass = 0, .damping = 0, .stiffness = 0};

Setup setup(int delay, const Hand& hand = {}) { return {.hand = hand, .timing = {.delay = delay}}; }

/// A column of doubles, first axis.
std::vector<double> column(const Trace& trace, std::string_view name) {
  std::vector<double> values(trace.size());
  for (const Column& c : trace.columns()) {
    if (c.name != name) continue;
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::memcpy(&values[i], trace.data() + i * trace.row_bytes() + c.offset, sizeof(double));
    }
  }
  return values;
}

/// The states of a run, as LinearLoop has them, minus those a tick earlier: what is constant drops
/// out.
std::vector<Eigen::VectorXd> changes(const Trace& trace, int delay) {
  const auto x = column(trace, "true.x");
  const auto v = column(trace, "true.v");
  const auto motor = column(trace, "true.f_motor");
  const auto estimate = column(trace, "v");
  const auto command = column(trace, "f_cmd");
  const auto state = [&](std::size_t k) {
    Eigen::VectorXd z(5 + delay);
    z.head<5>() << x[k], v[k], motor[k], x[k - 1], estimate[k - 1];
    for (int j = 0; j < delay; ++j) z[5 + j] = command[k - 1 - static_cast<std::size_t>(j)];
    return z;
  };
  std::vector<Eigen::VectorXd> found;
  for (std::size_t k = 20; k < trace.size(); ++k) found.emplace_back(state(k) - state(k - 1));
  return found;
}

TEST(LinearLoop, StepsLikeTheSimulation) {
  const Wall wall{.stiffness = 3e3, .damping = 4, .position = -1e-3};
  for (const int delay : {0, 1, 2, 5}) {
    for (const Velocity& estimator :
         {Velocity(BackwardDifference{}), Velocity(LowPass{.time_constant = 2e-3})}) {
      ebac::Setup s = setup(delay, {.path = {Step{.target = 0.01}}});
      s.environment = wall;
      s.device.encoder.counts_per_turn = 1 << 26;
      s.device.velocity = estimator;
      s.seconds = 0.1;
      const auto trace = simulate_any(s, any_law(Direct({.peak_force = 1e3})));
      const Eigen::MatrixXd matrix = LinearLoop(s).matrix(wall.stiffness, wall.damping);
      const auto states = changes(*trace, delay);
      for (std::size_t k = 1; k < states.size(); ++k) {
        const Eigen::VectorXd wrong = states[k] - matrix * states[k - 1];
        EXPECT_LT(std::abs(wrong[0]), 1e-11) << "delay " << delay << ", tick " << k;  // m
        EXPECT_LT(std::abs(wrong[1]), 1e-8);                                          // m/s
        EXPECT_LT(std::abs(wrong[2]), 1e-5);                                          // N
      }
    }
  }
}

TEST(LinearLoop, WithoutAWallItHasThePolesOfThePlant) {
  const LinearLoop loop(setup(0, kNoHand));
  const DeviceModel device;
  const double decay = std::exp(-device.mechanics.damping / device.mass() * 1e-3);
  EXPECT_NEAR(loop.spectral_radius(0, 0), 1, 1e-12);  // it stays where it is
  bool found = false;
  for (const auto& value : loop.eigenvalues(0, 0)) found |= std::abs(value - decay) < 1e-12;
  EXPECT_TRUE(found);
}

TEST(LinearLoop, TheLimitIsWhereTheRadiusReachesOne) {
  for (const int delay : {0, 1, 2}) {
    for (const double damping : {0.0, 5.0, 20.0}) {
      const LinearLoop loop(setup(delay));
      const double limit = loop.stiffness_limit(damping);
      EXPECT_LT(loop.spectral_radius(0.999 * limit, damping), 1);
      EXPECT_GT(loop.spectral_radius(1.001 * limit, damping), 1);
    }
  }
}

/// Gil et al.: K = (b + B)/(T/2 + t_d), good while damping is small against mass over delay.
TEST(LinearLoop, TheLimitIsNearTheFormulaForSmallDamping) {
  for (const int delay : {0, 1, 2}) {
    const ebac::Setup s = setup(delay);
    const double damping = s.device.mechanics.damping + s.hand.damping;
    const double late = s.timing.dt * (0.5 + delay) + s.device.drive.current_lag;
    EXPECT_NEAR(LinearLoop(s).stiffness_limit(0) / (damping / late), 1, 0.03) << "delay " << delay;
  }
}

TEST(LinearLoop, TooMuchWallDampingLeavesNoStiffness) {
  EXPECT_EQ(LinearLoop(setup(2, kNoHand)).stiffness_limit(400), 0);
}

TEST(LinearLoop, RefusesWhatIsNotLinear) {
  ebac::Setup gimbal = setup(1);
  gimbal.device.kinematics = Gimbal{};
  ebac::Setup window = setup(1);
  window.device.velocity = AdaptiveWindow{};
  ebac::Setup compensated = setup(1);
  compensated.device.compensation.friction = 0.1;
  for (const ebac::Setup& s : {gimbal, window, compensated}) {
    EXPECT_THROW(LinearLoop{s}, std::invalid_argument);
  }
}

}  // namespace
}  // namespace ebac::linear_loop_test
