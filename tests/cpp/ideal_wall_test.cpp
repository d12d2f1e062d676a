// The ideal wall against formulas and against small steps.
#include "ebac/sim/ideal_wall.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ebac::ideal_wall_test {
namespace {

Setup setup(const Hand& hand, const Wall& wall, double damping = 2) {
  Setup s{.hand = hand, .environment = wall};
  s.device.mechanics.damping = damping;
  return s;
}

IdealContact ideal(const Setup& s) {
  ContactRecorder recorder;
  return ideal_contact(s, recorder);
}

TEST(IdealWall, RestsWhereTheForcesBalance) {
  for (const double k : {100.0, 300.0, 1000.0}) {
    for (const double approach : {0.0, 0.01}) {
      const Hand hand{.stiffness = k, .path = {Step{.target = 0.03 + approach}}};
      const IdealContact c = ideal(setup(hand, {.position = approach}));
      EXPECT_NEAR(c.rest, approach + k * 0.03 / (k + 10e3), 1e-6);
      EXPECT_LT(c.swing, 1e-5);
      EXPECT_GE(c.settled, 0);
      EXPECT_LT(c.settled, 3);
      EXPECT_TRUE(c.quiet);
    }
  }
}

TEST(IdealWall, WithoutDampingItSwingsForEverAndAsDeepAgain) {
  const Hand hand{.mass = 0.15, .damping = 0, .stiffness = 300};
  const IdealContact c = ideal(setup(hand, {}, 0));
  const double rest = 300 * 0.04 / (300 + 10e3);
  EXPECT_NEAR(c.peak, 2 * rest, 1e-7);
  EXPECT_NEAR(c.swing, 2 * rest, 1e-5);  // sampled once a millisecond
  EXPECT_TRUE(std::isnan(c.settled));
  EXPECT_FALSE(c.quiet);
}

/// Runge and Kutta's steps of a microsecond: position every millisecond.
std::vector<double> small_steps(const Setup& s, const Wall& wall, int rows) {
  const double m = s.device.mass() + s.hand.mass;
  const auto rate = [&](std::array<double, 2> z) {
    const double pull = s.hand.stiffness * (s.hand.target(0, 0, 1e-3).x - z[0]) -
                        (s.hand.damping + s.device.mechanics.damping) * z[1] -
                        wall.push_along(z[0], z[1]);
    return std::array{z[1], pull / m};
  };
  std::array<double, 2> z{};
  const double h = 1e-6;
  const auto plus = [](std::array<double, 2> a, double f, std::array<double, 2> b) {
    return std::array{a[0] + f * b[0], a[1] + f * b[1]};
  };
  std::vector<double> x;
  for (int row = 0; row < rows; ++row) {
    x.push_back(z[0]);
    for (int i = 0; i < 1000; ++i) {
      const auto a = rate(z);
      const auto b = rate(plus(z, h / 2, a));
      const auto c = rate(plus(z, h / 2, b));
      const auto d = rate(plus(z, h, c));
      z = plus(plus(plus(plus(z, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
    }
  }
  return x;
}

TEST(IdealWall, BouncesLikeSmallSteps) {
  for (const double damping : {0.0, 30.0}) {
    const Wall wall{.damping = damping, .position = 0.01};
    const Hand hand{.mass = 0.5, .damping = 2, .stiffness = 300, .path = {Step{.target = 0.03}}};
    ebac::Setup s = setup(hand, wall);
    s.seconds = 1;
    ContactRecorder recorder;
    ideal_contact(s, recorder);
    const ContactRecord record = recorder.record();
    const std::vector<double> expected = small_steps(s, wall, 1001);
    ASSERT_EQ(record.x.size(), expected.size());
    double worst = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      worst = std::max(worst, std::abs(record.x[i] - expected[i]));
    }
    EXPECT_LT(worst, 1e-7) << "wall damping " << damping;
  }
}

TEST(IdealWall, FrictionHoldsItWithinItsBand) {
  ebac::Setup s = setup({.path = {Step{.target = 0.02}}}, {});
  s.device.mechanics.coulomb = 0.5;
  const IdealContact c = ideal(s);
  EXPECT_NEAR(c.rest, 300 * 0.02 / 10300, 0.5 / 10300 + 1e-9);
  EXPECT_EQ(c.swing, 0);
}

TEST(IdealWall, WeightAndItsCompensationCount) {
  ebac::Setup s = setup({}, {});
  s.device.mechanics.gravity = 9.81;
  s.device.compensation.gravity_mass = 0.05;
  const double weight = (s.device.mechanics.handle_mass - 0.05) * 9.81;
  EXPECT_NEAR(ideal(s).rest, (300 * 0.04 + weight) / 10300, 1e-7);
}

TEST(IdealWall, KnowsWhatItDoesNotCover) {
  const ebac::Setup turned = setup({}, {.angle = 0.1});
  ebac::Setup free = setup({}, {});
  free.environment = Free{};
  const ebac::Setup released = setup({.release_at = 1}, {});
  ebac::Setup gimbal = setup({}, {});
  gimbal.device.kinematics = Gimbal{};
  for (const ebac::Setup& s : {turned, free, released, gimbal}) {
    EXPECT_TRUE(std::isnan(ideal(s).rest));
    EXPECT_TRUE(std::isnan(ideal(s).settled));
  }
}

}  // namespace
}  // namespace ebac::ideal_wall_test
