// The numbers of a contact, on recordings whose numbers are known.
#include "ebac/sim/contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace ebac::contact_test {
namespace {

using Column = std::vector<double>;

Column times(std::size_t rows) {
  Column t(rows);
  for (std::size_t i = 0; i < rows; ++i) t[i] = 1e-3 * static_cast<double>(i);
  return t;
}

WallContact measure(const Column& x) {
  const Column t = times(x.size());
  return measure_contact({.t = t, .x = x, .force = x});
}

Column sine(double rest, double swing, double hertz, double ripple = 0) {
  Column x;
  for (const double t : times(6001)) {
    const double other = ripple * std::sin(2 * std::numbers::pi * 310 * t);
    x.push_back(rest + 0.5 * swing * std::sin(2 * std::numbers::pi * hertz * t) + other);
  }
  return x;
}

TEST(Contact, ASwingHasItsRestSizeAndFrequency) {
  for (const double hertz : {2.3, 11.7, 60.0, 170.0}) {
    const WallContact c = measure(sine(0.003, 0.002, hertz));
    EXPECT_NEAR(c.rest, 0.003, 1e-4);
    EXPECT_NEAR(c.swing, 0.002, 1e-4);
    EXPECT_NEAR(c.limit_cycle, hertz, 0.01 * hertz);
    EXPECT_TRUE(std::isnan(c.settled));
    EXPECT_FALSE(c.still());
    EXPECT_FALSE(c.quiet());
  }
}

TEST(Contact, TheShareOfAWallIsThatOfTheDeepestPosition) {
  Column x = sine(0.003, 0.002, 5);
  x[1234] = 0.01;
  Column wall = x;
  for (double& force : wall) force *= 1e4;
  Column force = wall;
  force[1234] = 25;
  const Column t = times(x.size());
  const auto share = [&](const Column& of) {
    return measure_contact({.t = t, .x = x, .force = force, .wall = of}).impact_share;
  };
  EXPECT_NEAR(share(wall), 0.25, 1e-12);
  wall[1234] = 0;  // the world does not act there
  EXPECT_TRUE(std::isnan(share(wall)));
  EXPECT_TRUE(std::isnan(share({})));
}

TEST(Contact, RippleAroundTheRestCountsNoCycle) {
  EXPECT_NEAR(measure(sine(0, 0.002, 5, 0.0002)).limit_cycle, 5, 0.05);
}

TEST(Contact, WhatDriftsHasNoFrequency) {
  Column x;
  for (const double t : times(1000)) x.push_back(0.01 * t);
  const WallContact c = measure(x);
  EXPECT_FALSE(c.quiet());
  EXPECT_TRUE(std::isnan(c.limit_cycle));
}

TEST(Contact, SettlesWhenItEntersTheBandForTheLastTime) {
  Column x(1000, 0.002);
  x[300] = 0.002 + 0.126e-3;
  x[400] = 0.002 - 0.124e-3;
  EXPECT_DOUBLE_EQ(measure(x).settled, 0.301);
}

WallContact account(const Column& energy, const Column& stored) {
  const Column t = times(energy.size());
  return measure_contact({.t = t, .x = t, .force = t, .energy = energy, .stored = stored});
}

TEST(Contact, MostDrawnIsTheDeepestFallBeyondWhatAnIdealWallStores) {
  const Column energy{0, 5, 1, 3, -1, 0, 0, 0, 0, 0};
  EXPECT_DOUBLE_EQ(account(energy, Column(10, 0)).most_drawn, 6);
  EXPECT_DOUBLE_EQ(account(energy, Column{0, 4, 0, 0, 0, 0, 0, 0, 0, 0}).most_drawn, 4);
  EXPECT_DOUBLE_EQ(account(energy, Column(10, 0)).least_energy, -1);
  EXPECT_TRUE(std::isnan(account(energy, {}).most_drawn));
}

TEST(Contact, TheLargestStepOfTheForceIsTakenFromTheWholeRun) {
  Column force(1000, 2);
  force[100] = -1.5;  // long before the tail
  const Column t = times(1000);
  EXPECT_DOUBLE_EQ(measure_contact({.t = t, .x = t, .force = force}).force_step, 3.5);
}

/// A force at a position that never moves.
WallContact push(const Column& force, double rate = 1000) {
  Column t(force.size());
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = static_cast<double>(i) / rate;
  const Column x(force.size(), 0.001);
  return measure_contact({.t = t, .x = x, .force = force});
}

/// Magnitudes of the two filters at a frequency, from their transfer functions.
double high_pass(double hertz, double rate) {
  const double k =
      std::tan(std::numbers::pi * hertz / rate) / std::tan(std::numbers::pi * 20 / rate);
  return k * k / std::sqrt(1 + k * k * k * k);
}

double low_pass(double hertz, double rate) {
  using Complex = std::complex<double>;
  const double w = 2 * std::numbers::pi * 200 / rate;
  const Complex pole = std::exp(Complex(-0.5 * w, std::sqrt(0.75) * w));
  const Complex delay = std::exp(Complex(0, -2 * std::numbers::pi * hertz / rate));
  return std::abs(std::norm(1.0 - pole) / ((1.0 - pole * delay) * (1.0 - std::conj(pole) * delay)));
}

TEST(Contact, AConstantForceIsQuietFromTheStart) {
  const WallContact c = push(Column(3000, 11.5));
  EXPECT_NEAR(c.force_rest, 11.5, 1e-12);
  EXPECT_EQ(c.force_settled, 0);
  EXPECT_EQ(c.ripple, 0);
  EXPECT_NEAR(c.ripple_rms, 0, 1e-12);
  EXPECT_NEAR(c.ripple_high, 0, 1e-12);
  EXPECT_EQ(c.jumps, 0);
  EXPECT_NEAR(c.perceived, 0, 1e-9);
  EXPECT_TRUE(c.force_quiet());
}

TEST(Contact, ARipplingForceIsWeighedAsTheFiltersSay) {
  for (const double rate : {500.0, 1000.0, 8000.0}) {
    for (const double hertz : {25.0, 40.0, 110.0, 170.0, 240.0}) {
      Column force;
      for (int i = 0; i < 6 * static_cast<int>(rate); ++i) {
        force.push_back(5 + 0.1 * std::sin(2 * std::numbers::pi * hertz * i / rate));
      }
      const WallContact c = push(force, rate);
      EXPECT_NEAR(c.ripple, 0.2, 0.2 * 0.05);
      EXPECT_NEAR(c.ripple_rms, 0.1 / std::numbers::sqrt2, 1e-3);
      const double high = 0.1 * high_pass(hertz, rate);
      EXPECT_NEAR(c.ripple_high, high / std::numbers::sqrt2, 0.01 * high);
      const double perceived = high * low_pass(hertz, rate) / 25e-3;
      EXPECT_NEAR(c.perceived, perceived, 0.03 * perceived)
          << hertz << " Hz at " << rate << " rows a second";
      EXPECT_EQ(c.force_quiet(), c.perceived < 3);
    }
  }
}

TEST(Contact, TheDetectedAmplitudeIsThatOfTheSource) {
  // Of a handle of 0.25 kg in the hand of Israr, Choi, Tan 2006.
  struct Point {
    double hertz, amplitude, impedance, newton;  // Hz, m, N s/m, N as documented
  };
  const auto less = [](double value, double decibel) {
    return value * std::pow(10, -decibel / 20);
  };
  const double at20 = 8.5e-6, z = 14;
  const Point points[] = {{20, at20, z, 37e-3},
                          {40, less(at20, 13), z, 31e-3},
                          {80, less(at20, 26), less(z, 7), 27e-3},
                          {160, less(at20, 39), less(z, 23), 24e-3},
                          {320, 0.06e-6, less(z, 23), 61e-3}};
  for (const Point& point : points) {
    const double w = 2 * std::numbers::pi * point.hertz;
    const double detected = std::hypot(w * 0.25, point.impedance) * w * point.amplitude;
    EXPECT_NEAR(detected, point.newton, 0.5e-3) << point.hertz;
    const double here = 25e-3 / (high_pass(point.hertz, 1e4) * low_pass(point.hertz, 1e4));
    EXPECT_LT(std::abs(20 * std::log10(here / detected)), 2) << point.hertz;
  }
}

TEST(Contact, AForceSettlesWhenItEntersItsBandForTheLastTime) {
  Column force(1000, 10);
  force[300] = 10.51;  // 5 % of 10 N is 0.5 N
  force[400] = 9.51;
  EXPECT_DOUBLE_EQ(push(force).force_settled, 0.301);
  Column weak(1000, 1);
  weak[300] = 1.21;  // 0.2 N is more than 5 % of it
  weak[400] = 1.19;
  EXPECT_DOUBLE_EQ(push(weak).force_settled, 0.301);
  weak[699] = 2;
  EXPECT_DOUBLE_EQ(push(weak).force_settled, 0.7);  // with the tail
  weak[700] = 2;
  EXPECT_TRUE(std::isnan(push(weak).force_settled));
  EXPECT_FALSE(push(weak).force_quiet());
}

TEST(Contact, RippleIsThatAfterPositionAndForceHaveSettled) {
  Column force(1000, 10);
  force[300] = 12;
  force[500] = 10.3;
  EXPECT_NEAR(push(force).ripple, 0.3, 1e-12);
  Column x(1000, 0.001);
  x[550] = 0.002;
  const Column t = times(1000);
  EXPECT_EQ(measure_contact({.t = t, .x = x, .force = force}).ripple, 0);
  for (std::size_t i = 0; i < x.size(); i += 2) x[i] = 0.002;  // never still: only the tail
  force[650] = 14;
  force[800] = 10.1;
  EXPECT_NEAR(measure_contact({.t = t, .x = x, .force = force}).ripple, 0.1, 1e-12);
}

TEST(Contact, AJumpIsMoreThanAFifthOfANewtonFromOneTickToTheNext) {
  Column force(1000, 2);
  for (std::size_t i = 400; i < force.size(); ++i) force[i] = 2.25;
  EXPECT_EQ(push(force).jumps, 1);
  force[600] = 2.06;  // 0.19 N down and up again
  EXPECT_EQ(push(force).jumps, 1);
  force[700] = 2.04;  // 0.21 N
  EXPECT_EQ(push(force).jumps, 3);
  Column x(1000, 0.001);
  x[400] = 0.002;  // settled only after the first
  const Column t = times(1000);
  EXPECT_EQ(measure_contact({.t = t, .x = x, .force = force}).jumps, 2);
}

TEST(Contact, ClicksArePerceivedThoughTheForceRestsAtTheEnd) {
  Column force(6000, 10);
  for (std::size_t i = 0; i < 3000; i += 20) force[i] = 10.45;  // within the band
  const WallContact c = push(force);
  EXPECT_EQ(c.force_settled, 0);
  EXPECT_EQ(c.force_swing, 0);
  EXPECT_GT(c.perceived, kQuietPerceived);
  EXPECT_FALSE(c.force_quiet());
  for (std::size_t i = 400; i < 3000; i += 20) force[i] = 10;
  EXPECT_TRUE(push(force).force_quiet());  // a short time after the arrival
}

TEST(Contact, VibrationCountsFromTwiceTheSettlingTime) {
  const Column t = times(6000);
  Column x(6000, 0.001);
  x[999] = 0.002;
  Column force(6000, 10);
  for (std::size_t i = 1000; i < 1990; i += 10) force[i] = 10.45;
  EXPECT_TRUE(measure_contact({.t = t, .x = x, .force = force}).force_quiet());
  for (std::size_t i = 2000; i < 2300; i += 10) force[i] = 10.45;
  EXPECT_FALSE(measure_contact({.t = t, .x = x, .force = force}).force_quiet());
}

TEST(Contact, FewRowsASecondShowNoVibration) {
  const WallContact c = push(Column(1000, 3), 79);
  EXPECT_TRUE(std::isnan(c.perceived));
  EXPECT_TRUE(std::isnan(c.ripple_high));
  EXPECT_EQ(c.ripple, 0);
  EXPECT_FALSE(c.force_quiet());
  EXPECT_TRUE(push(Column(1000, 3), 81).force_quiet());
}

TEST(Contact, TheHardestPullIsTheLargestRecorded) {
  const Column t = times(20);
  Column pull(20, 1);
  EXPECT_TRUE(std::isnan(measure_contact({.t = t, .x = t, .force = t}).most_pull));
  pull[3] = 7;
  EXPECT_DOUBLE_EQ(measure_contact({.t = t, .x = t, .force = t, .pull = pull}).most_pull, 7);
  pull.pop_back();
  EXPECT_THROW(measure_contact({.t = t, .x = t, .force = t, .pull = pull}), std::invalid_argument);
}

TEST(Contact, NothingIsDrawnFromAnIdealWall) {
  const Wall wall{.stiffness = 8e3, .position = 0.001};
  Column stored;
  for (const double x : sine(0.001, 0.004, 7)) stored.push_back(stored_energy(wall, {x, 0, 0}));
  EXPECT_NEAR(account(stored, stored).most_drawn, 0, 1e-18);
  Column leaking = stored;  // half a millijoule appears in the middle of the run
  for (std::size_t i = 3000; i < leaking.size(); ++i) leaking[i] -= 0.5e-3;
  EXPECT_NEAR(account(leaking, stored).most_drawn, 0.5e-3, 1e-9);
}

TEST(Contact, AnIdealEnvironmentStoresWhatItsSpringsHold) {
  EXPECT_EQ(stored_energy(Free{}, {1, 1, 1}), 0);
  EXPECT_EQ(stored_energy(Wall{.position = 0.01}, {0.005, 0, 0}), 0);
  EXPECT_DOUBLE_EQ(stored_energy(Wall{}, {0.002, 9, 9}), 0.02);
  const Wall turned{.angle = std::numbers::pi / 6};
  EXPECT_NEAR(stored_energy(turned, {0.002, 0.004, 0}),
              5e3 * std::pow(0.002 * std::cos(turned.angle) + 0.002, 2), 1e-15);
  const Disc disc{.x = 0.03, .y = 0.04, .radius = 0.048};
  EXPECT_NEAR(stored_energy(disc, {0, 0, 0}), 0, 0);
  EXPECT_NEAR(stored_energy(disc, {0.003, 0.004, 0}), 5e3 * 0.003 * 0.003, 1e-15);
  EXPECT_NEAR(stored_energy(Corner{}, {0.002, 0.001, 0}), 0.02 + 0.005, 1e-15);
}

TEST(Contact, ARecordingTooShortOrTornIsRefused) {
  EXPECT_THROW(measure(Column(9, 0)), std::invalid_argument);
  const Column t = times(20);
  const Column force = times(19);
  EXPECT_THROW(measure_contact({.t = t, .x = t, .force = force}), std::invalid_argument);
  EXPECT_THROW(measure_contact({.t = t, .x = t, .force = t, .energy = force}),
               std::invalid_argument);
}

}  // namespace
}  // namespace ebac::contact_test
