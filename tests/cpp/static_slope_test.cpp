#include "ebac/control/static_slope.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ebac::static_slope_test {
namespace {

constexpr double kTick = 1e-3;      // s
constexpr double kLeast = 1e-7;     // m
constexpr double kDamping = 30;     // N s/m
constexpr double kStiffness = 5e3;  // N/m

/// Lets a handle swing by 0.1 mm at 20 Hz in a wall of `damping` for a time.
void swing(StaticSlope& slope, double damping, int first, int last) {
  for (int i = first; i < last; ++i) {
    const double w = 2 * M_PI * 20, t = i * kTick;
    const double x = 1e-3 + 1e-4 * std::sin(w * t), v = 1e-4 * w * std::cos(w * t);
    slope.step(kStiffness * x + damping * v, x, v, 0);
  }
}

TEST(StaticSlope, TheDampingOfAWallIsBelievedSlowlyAndIsNoStiffness) {
  StaticSlope slope(kLeast);
  swing(slope, kDamping, 0, 10);
  EXPECT_LT(slope.damping(), kDamping / 4);
  EXPECT_NEAR(slope.value(), kStiffness, 1e-3);
  swing(slope, kDamping, 10, 300);
  EXPECT_NEAR(slope.damping(), kDamping, 0.1);
}

TEST(StaticSlope, DampingThatEndsIsForgottenAtOnce) {
  StaticSlope slope(kLeast);
  swing(slope, kDamping, 0, 300);
  swing(slope, 0, 300, 304);
  EXPECT_EQ(slope.damping(), 0);
}

TEST(StaticSlope, AContactThatEndsHasNone) {
  StaticSlope slope(kLeast);
  swing(slope, kDamping, 0, 300);
  slope.step(0, -1e-3, 0, 0);
  EXPECT_EQ(slope.damping(), 0);
  EXPECT_EQ(slope.value(), 0);
}

}  // namespace
}  // namespace ebac::static_slope_test
