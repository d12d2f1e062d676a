#include "ebac/control/static_slope.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

TEST(StaticSlope, AMotionOfLessThanTheLeastInEachTickShowsItInTime) {
  StaticSlope slope(kLeast);
  const double step = kLeast / 10;  // a slow hand, or a fast loop
  int ticks = 0;
  for (double x = -2 * step; slope.value() == 0 && ticks < 100; x += step, ++ticks) {
    slope.step(kStiffness * std::max(x, 0.0), x, step / kTick, 0);
  }
  EXPECT_NEAR(slope.value(), kStiffness, 1e-3);
  EXPECT_LT(ticks, 20);
}

TEST(StaticSlope, TheSurfaceIsFollowedUntilASlopeIsKnown) {
  StaticSlope slope(kLeast);
  const double step = kLeast / 10;
  for (int i = -2; slope.value() == 0 && i < 100; ++i) {
    const double x = 2 * i * step;
    const double surface = i * step;  // recedes half as fast as the handle comes
    slope.step(kStiffness * std::max(x - surface, 0.0), x, 2 * step / kTick, step);
  }
  EXPECT_NEAR(slope.value(), kStiffness, 1e-3);
}

TEST(StaticSlope, TheFirstForceShowsWhatASpringHasAtLeast) {
  StaticSlope slope(kLeast);
  EXPECT_EQ(slope.at_least(), std::numeric_limits<double>::infinity());
  slope.step(0, -3e-5, 0.05, 0);
  slope.step(kStiffness * 2e-5, 2e-5, 0.05, 0);
  EXPECT_NEAR(slope.at_least(), 0.4 * kStiffness, 1e-6);  // it met the surface on the way
  slope.step(0, -3e-5, -0.05, 0);
  EXPECT_EQ(slope.at_least(), std::numeric_limits<double>::infinity());
}

TEST(StaticSlope, AContactThatDidNotBeginFromOutsideShowsNoLeast) {
  StaticSlope slope(kLeast);
  slope.step(kStiffness * 1e-3, 1e-3, 0, 0);  // at first, and where nothing is known of the contact
  EXPECT_EQ(slope.at_least(), std::numeric_limits<double>::infinity());
  slope.forget();
  slope.step(kStiffness * 1e-3, 1e-3, 0, 0);
  EXPECT_EQ(slope.at_least(), std::numeric_limits<double>::infinity());
}

TEST(StaticSlope, AWorldThatOnlyDampsHasNone) {
  StaticSlope slope(kLeast);
  bool changed = false;
  for (int i = 0; i < 300; ++i) {
    const double t = i * kTick;
    changed |=
        slope.step(kDamping * std::cos(40 * t), 0.025 * std::sin(40 * t), std::cos(40 * t), 0);
  }
  EXPECT_FALSE(changed);  // or one would divide by it
  EXPECT_EQ(slope.value(), 0);
  EXPECT_EQ(slope.at_least(), 0);
  EXPECT_NEAR(slope.damping(), kDamping, 1);
}

}  // namespace
}  // namespace ebac::static_slope_test
