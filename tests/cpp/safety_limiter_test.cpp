// The safety limiter: limits of a current, and conditions that end a run.
#include "ebac/loop/safety_limiter.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace ebac::safety_limiter_test {
namespace {

constexpr double kDt = 1e-3;
const DeviceModel kDevice{};

/// A limiter with one axis, pushed by hand.
struct Pushed {
  Limits limits = Limits::of(kDevice);
  SafetyLimiter limiter{limits, kDevice, kDt};
  std::array<Axis, 1> axes{};
  int limited = 0;

  double pass(double current, double gain = 1) {
    axes[0].joint.current = current;
    limited = limiter.limit(axes, gain, kDt);
    return axes[0].joint.current;
  }
  bool because(Limited why) const { return (limited & static_cast<int>(why)) != 0; }
};

TEST(SafetyLimiter, LimitsOfADeviceAreItsMotors) {
  const Limits limits = Limits::of(kDevice);
  EXPECT_NEAR(kDevice.force(limits.continuous_current), 10.6, 0.01);  // N, the paper's
  EXPECT_NEAR(kDevice.force(limits.peak_current), 42.4, 0.01);
}

TEST(SafetyLimiter, EdgeAndEndLieAroundTheStops) {
  DeviceModel device = kDevice;
  device.kinematics = Linear{.radius = 0.12, .limit = 0.2};
  EXPECT_NEAR(Limits::of(device).edge, 0.019, 1e-12);  // m
  EXPECT_NEAR(Limits::of(device).end, 0.029, 1e-12);
}

TEST(SafetyLimiter, LeavesAloneWhatIsAllowed) {
  Pushed p;
  EXPECT_EQ(p.pass(0.5), 0.5);
  EXPECT_EQ(p.limited, 0);
}

TEST(SafetyLimiter, HoldsThePeakOfEitherSign) {
  Pushed p;
  for (const double sign : {1.0, -1.0}) {
    for (int k = 0; k < 2; ++k) p.pass(sign * 3);  // so near that the slew allows the peak
    EXPECT_EQ(p.pass(sign * 100), sign * p.limits.peak_current);
    EXPECT_TRUE(p.because(Limited::kPeak));
  }
  EXPECT_EQ(p.pass(std::nan("")), 0);
  EXPECT_TRUE(p.because(Limited::kNotFinite));
}

TEST(SafetyLimiter, LimitsEveryAxis) {
  Pushed p;
  std::array<Axis, kMaxAxes> axes{};
  for (int k = 0; k < 3; ++k) {
    for (Axis& axis : axes) axis.joint.current = 100;
    p.limiter.limit(axes, 1, kDt);
  }
  for (const Axis& axis : axes) EXPECT_EQ(axis.joint.current, p.limits.peak_current);
}

TEST(SafetyLimiter, HoldsTheSlew) {
  Pushed p;
  p.limits.slew = 1000;
  p.limiter = SafetyLimiter(p.limits, kDevice, kDt);
  EXPECT_DOUBLE_EQ(p.pass(3), 1);
  EXPECT_TRUE(p.because(Limited::kSlew));
  EXPECT_DOUBLE_EQ(p.pass(3), 2);
  EXPECT_DOUBLE_EQ(p.pass(-3), 1);
}

TEST(SafetyLimiter, AWarmMotorComesDownToItsContinuousCurrentAndNeverGetsHotter) {
  Pushed p;
  double warm = 0;  // s, until the peak is over
  for (int k = 0; k < 100'000; ++k) {
    const double current = p.pass(100);
    EXPECT_LE(p.limiter.state(0).heat, 1 + 1e-12);
    if (current == p.limits.peak_current) warm = k * kDt;
  }
  // i2t in closed form: heat = 16 (1 - exp(-t/tau)) reaches 1.
  const double ratio = std::pow(p.limits.peak_current / p.limits.continuous_current, 2);
  EXPECT_NEAR(warm, -p.limits.thermal_time * std::log(1 - 1 / ratio), 2 * kDt);
  EXPECT_NEAR(p.pass(100), p.limits.continuous_current, 1e-6);
  EXPECT_TRUE(p.because(Limited::kThermal));
  for (int k = 0; k < 100'000; ++k) p.pass(0);
  EXPECT_EQ(p.pass(100), p.limits.peak_current) << "it has cooled";
}

TEST(SafetyLimiter, AStopDoesNotCoolTheModel) {
  Pushed p;
  for (int k = 0; k < 1000; ++k) p.pass(100);
  const double heat = p.limiter.state(0).heat;
  p.limiter.restart();
  p.pass(0);
  EXPECT_NEAR(p.limiter.state(0).heat, heat, 0.01);
}

TEST(SafetyLimiter, TheEdgePushesInwardsOnly) {
  Pushed p;
  for (const double side : {1.0, -1.0}) {
    const double depth = 2e-3;
    p.axes[0].joint.q = side * (p.limits.edge + depth) / kDevice.radius();
    const double wanted = p.limits.edge_stiffness * depth;
    EXPECT_NEAR(kDevice.force(p.pass(0)), side * wanted, 1e-9);
    EXPECT_TRUE(p.because(Limited::kEdge));
    p.axes[0].joint.dq = -side * 10;  // on its way back: it never pulls
    EXPECT_EQ(p.pass(0), 0);
    p.axes[0].joint.dq = 0;
  }
}

TEST(SafetyLimiter, AGainOfARampScalesTheForce) {
  Pushed p;
  EXPECT_EQ(p.pass(1, 0.25), 0.25);
  EXPECT_TRUE(p.because(Limited::kRamp));
}

TEST(SafetyLimiter, ShutLeavesNoCurrent) {
  for (const bool on : {true, false}) {
    Pushed p;
    if (!on) p.limiter = SafetyLimiter();
    EXPECT_EQ(p.pass(2), 2);
    p.limiter.shut(p.axes, kDt);
    EXPECT_EQ(p.axes[0].joint.current, 0);
  }
}

Fault seen(Pushed& p, const Reading& reading = {}, std::int64_t skipped = 0) {
  return p.limiter.watch(reading, {.dt = kDt, .skipped = skipped}, p.axes);
}

TEST(SafetyLimiter, WhatNobodySawForSomeTicksMayHaveGoneSoMuchFurther) {
  const double radius = kDevice.radius();
  const auto jumped = [&](double share, double age) {
    Pushed p;
    p.limits.speed = 100;
    p.limiter = SafetyLimiter(p.limits, kDevice, kDt);
    p.limiter.watch({}, {}, p.axes);
    Reading held;
    held.counts_age[0] = age;
    if (age > 0) p.limiter.watch(held, {.dt = age}, p.axes);
    p.axes[0].joint.q = share * p.limits.jump / radius;
    return p.limiter.watch({}, {.dt = kDt}, p.axes);
  };
  EXPECT_EQ(jumped(0.99, 0), Fault::kNone);
  EXPECT_EQ(jumped(1.01, 0), Fault::kEncoderJump);
  EXPECT_EQ(jumped(3.99, 3 * kDt), Fault::kNone);
  EXPECT_EQ(jumped(4.01, 3 * kDt), Fault::kEncoderJump);
}

/// Ticks of an axis at `pace` m/s, as whole counts: the fault found in any of them.
Fault seen_at(double pace, std::initializer_list<double> ticks, const Limits& limits) {
  Pushed p;
  p.limiter = SafetyLimiter(limits, kDevice, kDt);
  const double count = kDevice.facts().count;
  double x = 0;
  Fault found = p.limiter.watch({}, {}, p.axes);
  for (int k = 0; k < 1000; ++k) {
    for (const double dt : ticks) {
      x += pace * dt;
      p.axes[0].joint.q = std::round(x / count) * count / kDevice.radius();
      if (std::abs(x) > 0.9 * limits.edge) return found;
      if (found == Fault::kNone) found = p.limiter.watch({}, {.dt = dt}, p.axes);
    }
  }
  return found;
}

TEST(SafetyLimiter, JudgesSpeedAtAnyRateAndThroughShortTicks) {
  Limits limits = Limits::of(kDevice);
  limits.speed = 1;
  const std::initializer_list<double> at_1_kHz = {1e-3}, late = {1.7e-3, 0.3e-3},
                                      at_10_kHz = {1e-4}, late_10 = {17e-5, 27e-6, 1e-5, 193e-6};
  for (const auto& ticks : {at_1_kHz, late, at_10_kHz, late_10}) {
    EXPECT_EQ(seen_at(0.99, ticks, limits), Fault::kNone);
    EXPECT_EQ(seen_at(1.08, ticks, limits), Fault::kOverspeed);
    EXPECT_EQ(seen_at(-1.08, ticks, limits), Fault::kOverspeed);
  }
}

TEST(SafetyLimiter, OneCountIsNoSpeedHoweverSmallTheLimit) {
  Limits limits = Limits::of(kDevice);
  limits.speed = 0.01;  // m/s: less than a count in a tick
  EXPECT_EQ(seen_at(0.0099, {1e-3}, limits), Fault::kNone);
  EXPECT_EQ(seen_at(0.1, {1e-3}, limits), Fault::kOverspeed);
}

TEST(SafetyLimiter, NamesWhatItSees) {
  const double radius = kDevice.radius();
  Pushed p;
  EXPECT_EQ(seen(p), Fault::kNone);
  p.axes[0].joint.q = 2 * p.limits.jump / radius;
  EXPECT_EQ(seen(p), Fault::kEncoderJump);
  EXPECT_EQ(seen(p), Fault::kNone);
  p.axes[0].joint.q -= 2 * p.limits.speed * kDt / radius;
  EXPECT_EQ(seen(p), Fault::kOverspeed);
  for (const double sign : {1.0, -1.0}) {
    p.limiter.restart();
    p.axes[0].joint.q = sign * 0.99 * p.limits.end / radius;
    EXPECT_EQ(seen(p), Fault::kNone);
    p.axes[0].joint.q = sign * 1.01 * p.limits.end / radius;
    EXPECT_EQ(seen(p), Fault::kWorkspace);
  }
  p.axes[0].joint.q = 0;
  p.limiter.restart();
  EXPECT_EQ(seen(p, {.force_age = 1}), Fault::kForceStale);
  EXPECT_EQ(seen(p, {.force_age = std::nan("")}), Fault::kForceStale);
  EXPECT_EQ(seen(p, {.force_status = static_cast<SensorStatus>(9)}), Fault::kForceError);
  EXPECT_EQ(seen(p, {.force_status = SensorStatus::kSaturated}), Fault::kForceSaturated);
  EXPECT_EQ(seen(p, {.force_status = SensorStatus::kDisconnected}), Fault::kForceDisconnected);
  EXPECT_EQ(seen(p, {.force_status = SensorStatus::kError}), Fault::kForceError);
  for (int k = 1; k < p.limits.overruns; ++k) EXPECT_EQ(seen(p, {}, 1), Fault::kNone);
  EXPECT_EQ(seen(p, {}, 1), Fault::kOverruns);
  EXPECT_EQ(seen(p, {}, 0), Fault::kNone);
}

TEST(SafetyLimiter, HasABudgetOfLostTimeForOnePauseAndForMany) {
  Limits limits = Limits::of(kDevice);
  limits.overruns = 1000;
  ASSERT_EQ(limits.pause, 0.05);
  // Ticks until a fault when each `every`-th one comes `skipped` too late, or 10000.
  const auto found = [&](int skipped, int every) {
    SafetyLimiter limiter(limits, kDevice, kDt);
    const std::array<Axis, 1> axes{};
    for (int i = 1; i <= 10'000; ++i) {
      const int lost = i % every == 0 ? skipped : 0;
      const Instant now{.dt = (1 + lost) * kDt, .skipped = lost};
      if (limiter.watch({}, now, axes) != Fault::kNone) return i;
    }
    return 10'000;
  };
  EXPECT_EQ(found(49, 5000), 10'000);
  EXPECT_EQ(found(51, 1), 1) << "one pause, not so many ticks";
  EXPECT_EQ(found(62, 3), 3);
  EXPECT_EQ(found(5000, 7), 7);
  EXPECT_EQ(found(2, 100), 10'000) << "2 % of the time";
  EXPECT_LE(found(20, 100), 400) << "20 % of it";

  const SafetyLimiter limiter(limits, kDevice, kDt);
  EXPECT_FALSE(limiter.paused({.dt = 10 * kDt, .skipped = 9}));
  EXPECT_TRUE(limiter.paused({.dt = 12 * kDt, .skipped = 11}));
  EXPECT_FALSE(SafetyLimiter().paused({.skipped = 1000}));
}

TEST(SafetyLimiter, RefusesLimitsThatContradictEachOther) {
  Limits limits;
  limits.continuous_current = 2 * limits.peak_current;
  EXPECT_THROW(SafetyLimiter(limits, kDevice, kDt), std::invalid_argument);
  limits = {};
  limits.end = 0.5 * limits.edge;
  EXPECT_THROW(SafetyLimiter(limits, kDevice, kDt), std::invalid_argument);
}

}  // namespace
}  // namespace ebac::safety_limiter_test
