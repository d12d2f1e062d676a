#include "ebac/control/motion_guard.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ebac/model/noise.hpp"

namespace ebac {
namespace {

constexpr double kTick = 1e-3;      // s
constexpr double kDamping = 2;      // N s/m
constexpr double kMass = 0.25;      // kg
constexpr double kCount = 3.07e-5;  // m
constexpr double kPull = 20;        // N
constexpr double kB = kDamping / kTick;

/// Largest energy a force gives out over a displacement within `reach` of `step`, by trying them
/// all.
double worst(double force, double step, double reach) {
  constexpr int kTries = 4000;
  double most = 0;
  for (int i = -kTries; i <= kTries; ++i) {
    const double s = step + reach * i / kTries;
    most = std::max(most, -force * s - kB * s * s);
  }
  return most;
}

double need(double force, double asked, const Pending& pending, double v) {
  const double largest = pending.largest_with(force);
  const double jump = (kPull + pending.largest_with(asked)) / kMass * kTick * kTick;
  double sum = worst(force, v * kTick, (1 + pending.size()) * jump) + kCount * largest;
  for (int j = 0; j < pending.size(); ++j) sum += worst(pending[j], v * kTick, (1 + j) * jump);
  return sum;
}

class Guard : public testing::TestWithParam<int> {};

TEST_P(Guard, AdmitsTheLargestForceTheEnergyCovers) {
  const MotionGuard guard(kDamping, kMass, kCount, kPull, kTick);
  Noise random(1);
  for (int i = 0; i < 2000; ++i) {
    Pending pending(GetParam());
    for (int j = 0; j < GetParam(); ++j) pending.push(15 * random.normal());
    const double asked = 20 * random.normal();
    const double v = 0.3 * random.normal();
    const double energy = 0.02 * (1 + random.symmetric());
    const double given = guard.admit(asked, pending, energy, v);

    ASSERT_LE(std::abs(given), std::abs(asked));
    ASSERT_GE(given * asked, 0);
    if (given == 0) continue;
    ASSERT_LE(need(given, asked, pending, v), energy * (1 + 1e-6));  // covered
    if (given != asked) {                                            // and not by a hair less
      ASSERT_GT(need(given * (1 + 1e-3), asked, pending, v), energy * (1 - 1e-3));
    }
  }
}

TEST_P(Guard, TheCheapTestNeverAdmitsMoreThanTheExactOne) {
  const MotionGuard guard(kDamping, kMass, kCount, kPull, kTick);
  Noise random(2);
  int admitted = 0;
  for (int i = 0; i < 20000; ++i) {
    Pending pending(GetParam());
    for (int j = 0; j < GetParam(); ++j) pending.push(10 * random.normal());
    const double asked = 10 * random.normal();
    const double v = 0.1 * random.normal();
    const double energy = 0.03 * (1 + random.symmetric());
    if (!guard.surely_admits(asked, pending, energy, std::abs(v) * kTick)) continue;
    ++admitted;
    ASSERT_EQ(guard.admit(asked, pending, energy, v), asked);
  }
  EXPECT_GT(admitted, 1000);
}

INSTANTIATE_TEST_SUITE_P(Delay, Guard, testing::Values(0, 1, 2));

}  // namespace
}  // namespace ebac
