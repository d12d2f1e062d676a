#include "ebac/control/dynamic_stiffness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace ebac::dynamic_stiffness_test {
namespace {

constexpr double kFast = 3e3;    // N/m
constexpr double kCount = 3e-5;  // m
constexpr double kTick = 1e-4;   // s

/// What is shown of `force` in the next tick.
double next(DynamicStiffness& dynamic, double force, double slope, double softer) {
  dynamic.follow(force, slope, kTick);
  return dynamic.shown(force, softer);
}
double next(DynamicStiffness&& dynamic, double force, double slope, double softer) {
  return next(dynamic, force, slope, softer);
}

/// One in a contact that has lasted at `force`.
DynamicStiffness rested(double force, double slope) {
  DynamicStiffness shown(kFast, kCount);
  shown.forget();
  shown.follow(force, slope, kTick);
  return shown;
}

TEST(DynamicStiffness, AtRestTheForceIsTheWorlds) {
  for (const double slope : {1e3, 4e3, 35e3}) {
    EXPECT_NEAR(next(rested(5, slope), 5, slope, 1), 5, 1e-9) << slope;
  }
}

TEST(DynamicStiffness, ASmallFastChangeHasTheFastStiffness) {
  for (const double slope : {1e3, 4e3, 10e3, 35e3}) {
    const double moved = 1e-6;  // m
    const double change = next(rested(5, slope), 5 + slope * moved, slope, 1) - 5;
    EXPECT_NEAR(change / moved, std::min(slope, std::max(kFast, slope / 8)), 0.01 * slope) << slope;
  }
}

TEST(DynamicStiffness, NoChangeIsShownFurtherOffThanASmallOne) {
  for (double force = -40; force <= 40; force += 0.05) {
    for (const double softer : {-1.0, 1.0}) {
      const double shown = next(rested(5, 35e3), force, 35e3, softer);
      EXPECT_LE(std::abs(shown - force), 0.29 * 6 * kCount * 35e3);
      EXPECT_GE(shown * force, 0) << "against the world's force, " << force << " N";
    }
  }
}

/// Against a hand that pushes steadily from some instant on, the force ends as a critically damped
/// pair of 90 ms does, on every world.
TEST(DynamicStiffness, ItEndsTheSameOnEveryWorld) {
  for (const double slope : {4e3, 10e3, 35e3}) {
    const double share = std::min(1 - kFast / slope, 7.0 / 8);
    const double push = 5.001;  // N, of the hand, 5 N before
    DynamicStiffness shown = rested(5, slope);
    double lagged = 5;
    double force = push;
    for (int k = 0; k < 1800; ++k) {
      force = (push - share * lagged) / (1 - share);  // the world's where what is shown is the push
      lagged = force - (force - next(shown, force, slope, 1)) / share;
    }
    const double left = (push - lagged) / (push - 5);
    EXPECT_NEAR(left, 3 * std::exp(-2), 0.01) << slope;  // after twice 90 ms
  }
}

}  // namespace
}  // namespace ebac::dynamic_stiffness_test
