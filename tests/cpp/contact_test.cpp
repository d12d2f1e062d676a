// The numbers of a contact, on recordings whose numbers are known.
#include "ebac/sim/contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace ebac {
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
    EXPECT_FALSE(c.quiet());
  }
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
}  // namespace ebac
