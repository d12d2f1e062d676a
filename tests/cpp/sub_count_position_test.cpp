#include "ebac/control/sub_count_position.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ebac/control/energy_ledger.hpp"

namespace ebac::sub_count_position_test {
namespace {

constexpr double kCount = 3.07e-5;   // m
constexpr double kTick = 1e-3;       // s
constexpr double kStiffness = 10e3;  // N/m
constexpr int kTicks = 120'000;      // two minutes

double read(double x) { return kCount * std::round(x / kCount); }

/// By how much a ledger falls short of the true work [J] after two minutes of a device that ripples
/// by less than a count around an edge, under a spring on whole counts that acts one tick late.
/// `whole` takes the work over whole counts, as a reading has it.
double lost(double amplitude, double frequency, bool whole) {
  EnergyLedger ledger(2.0, kCount, 0.0, 0.0);
  ledger.set_tick(kTick);
  SubCountPosition edge(kCount);
  const double start = 40.5 * kCount;  // an edge between two counts
  double x = start;
  double before = read(x);
  double force = kStiffness * before;
  double truth = 0;
  edge.start(before);
  for (int k = 1; k <= kTicks; ++k) {
    const double next =
        start + amplitude * std::sin(2 * std::numbers::pi * frequency * k * kTick + 0.3);
    truth += force * (next - x);  // what the force held over the tick really took in
    x = next;
    const double reading = read(x);
    const double moved = edge.step(reading, kTick);
    ledger.take(force, whole ? reading - before : moved, reading - before);
    before = reading;
    force = kStiffness * reading;
  }
  return truth - ledger.energy();
}

TEST(SubCountPosition, AWallThatRipplesWithinACountForTwoMinutesKeepsItsLedger) {
  for (const double amplitude : {0.05, 0.1, 0.3, 0.45}) {
    for (const double frequency : {1.1, 5.3, 17.3, 41.7}) {
      const double whole = lost(amplitude * kCount, frequency, true);
      const double edge = lost(amplitude * kCount, frequency, false);
      EXPECT_GT(whole, 1e-3);  // half a count of work with every toggle: the wall dissolves
      EXPECT_LT(edge, 0.5e-3) << amplitude << " counts, " << frequency << " Hz";
      EXPECT_LT(std::abs(edge), 0.2 * whole) << amplitude << " counts, " << frequency << " Hz";
    }
  }
}

/// Two counts from the device at most: one it may have turned within, one it was thought to go on.
TEST(SubCountPosition, StaysWithinTwoCountsOfTheDevice) {
  for (const double speed : {0.01, 0.3, 2.0, 7.7}) {  // counts a tick
    SubCountPosition edge(kCount);
    double x = 0;
    edge.start(read(x));
    double estimate = read(x);
    for (int k = 1; k <= 2000; ++k) {
      x += (k / 500 % 2 ? -1 : 1) * speed * kCount;
      estimate += edge.step(read(x), kTick);
      ASSERT_LE(std::abs(estimate - x), 2 * kCount) << speed << " counts a tick, tick " << k;
    }
  }
}

TEST(SubCountPosition, IsStillWhileTheReadingIs) {
  SubCountPosition edge(kCount);
  edge.start(0.0);
  for (int k = 0; k < 100; ++k) {
    EXPECT_EQ(edge.step(0.0, kTick), 0.0);
    EXPECT_EQ(edge.direction(), 0);
  }
}

TEST(SubCountPosition, ADirectionIsToldAtAnEdgeAndNotWithinIt) {
  SubCountPosition edge(kCount);
  edge.start(0.0);
  edge.step(kCount, kTick);
  EXPECT_EQ(edge.direction(), 1);
  edge.step(0.0, kTick);  // to and fro over the same edge
  EXPECT_EQ(edge.direction(), 0);
  edge.step(-kCount, kTick);
  EXPECT_EQ(edge.direction(), -1);
}

}  // namespace
}  // namespace ebac::sub_count_position_test
