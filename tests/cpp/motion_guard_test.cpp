#include "ebac/control/motion_guard.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "ebac/model/noise.hpp"
#include "rounds.hpp"

namespace ebac::motion_guard_test {
namespace {

constexpr double kTick = 1e-3;      // s
constexpr double kDamping = 2;      // N s/m
constexpr double kMass = 0.25;      // kg
constexpr double kCount = 3.07e-5;  // m
constexpr double kPull = 20;        // N
constexpr double kB = kDamping / kTick;

/// Largest energy a force gives out over a displacement within `reach` of `step`, by trying them
/// all, with what a surface takes that yields to it by `way`.
double worst(double force, double step, double reach, double way) {
  constexpr int kTries = 4000;
  const double yielded = std::max(0.0, force * way);
  double most = 0;
  for (int i = -kTries; i <= kTries; ++i) {
    const double s = step + reach * i / kTries;
    most = std::max(most, yielded - force * s - kB * s * s);
  }
  return most;
}

/// What the guard has to cover: every force as it is behind the current loop, and after the last
/// command what the loop still gives out until nothing is left.
double need(double force, double asked, const CommandsInFlight& in_flight, LaggedForce lagged,
            double v, double surface) {
  const double largest = std::max(in_flight.largest_with(force), std::abs(lagged.force()));
  const double most = std::max({in_flight.largest_with(asked), std::abs(lagged.force())});
  const double jump = (kPull + most) / kMass * kTick * kTick;
  double sum = kCount * largest;
  int interval = 0;
  const auto hold = [&](double command) {
    sum += worst(lagged.hold(command), v * kTick, ++interval * jump, surface * kTick);
  };
  for (int j = 0; j < in_flight.size(); ++j) hold(in_flight[j]);
  hold(force);
  while (lagged.ticks() > 0 && std::abs(lagged.force()) > 1e-3) hold(0);
  return sum;
}

LaggedForce lagged_force(double lag, double force) {
  LaggedForce lagged(lag);
  lagged.set_tick(100 * kTick);
  lagged.hold(force);
  lagged.set_tick(kTick);
  return lagged;
}

/// Delay [samples] and lag of the current loop [s].
class Guard : public testing::TestWithParam<std::tuple<int, double>> {
 protected:
  int delay() const { return std::get<0>(GetParam()); }
  double lag() const { return std::get<1>(GetParam()); }
};

TEST_P(Guard, AdmitsTheLargestForceTheEnergyCovers) {
  const MotionGuard guard(kDamping, kMass, kCount, kTick);
  Noise random(1);
  for (int i = 0; i < rounds(2000); ++i) {
    CommandsInFlight in_flight(delay());
    for (int j = 0; j < delay(); ++j) in_flight.push(15 * random.normal());
    const LaggedForce lagged = lagged_force(lag(), 15 * random.normal());
    const double asked = 20 * random.normal();
    const double v = 0.3 * random.normal();
    const double surface = i % 2 == 0 ? 0 : 0.1 * random.normal();  // m/s
    // Behind a lag the tail of a force counts on what the device damps in the first interval: up to some microjoules.
    const bool little = lag() == 0 && i % 3 == 0;
    const double energy =
        little ? std::pow(10, -5 + 3 * random.symmetric()) : 0.02 * (1 + random.symmetric());
    const double given = guard.admit(asked, in_flight, lagged, energy, v, kPull, surface);

    ASSERT_LE(std::abs(given), std::abs(asked));
    ASSERT_GE(given * asked, 0);
    if (given == 0) continue;
    ASSERT_LE(need(given, asked, in_flight, lagged, v, surface), energy * (1 + 1e-6));  // covered
    if (given != asked && lag() == 0) {  // and not by a hair less
      ASSERT_GT(need(given * (1 + 1e-3), asked, in_flight, lagged, v, surface),
                energy * (1 - 1e-3));
    }
  }
}

TEST_P(Guard, TheCheapTestNeverAdmitsMoreThanTheExactOne) {
  const MotionGuard guard(kDamping, kMass, kCount, kTick);
  Noise random(2);
  int admitted = 0;
  for (int i = 0; i < rounds(20000); ++i) {
    CommandsInFlight in_flight(delay());
    for (int j = 0; j < delay(); ++j) in_flight.push(10 * random.normal());
    const LaggedForce lagged = lagged_force(lag(), 10 * random.normal());
    const double asked = 10 * random.normal();
    const double v = 0.1 * random.normal();
    const double surface = i % 2 == 0 ? 0 : 0.1 * random.normal();  // m/s
    const double energy = 0.03 * (1 + random.symmetric());
    if (!guard.surely_admits(asked, in_flight, lagged, energy, std::abs(v) * kTick, kPull, surface))
      continue;
    ++admitted;
    ASSERT_EQ(guard.admit(asked, in_flight, lagged, energy, v, kPull, surface), asked);
  }
  EXPECT_GT(admitted, rounds(1000));
}

INSTANTIATE_TEST_SUITE_P(DelayAndLag, Guard,
                         testing::Combine(testing::Values(0, 1, 2),
                                          testing::Values(0.0, 3e-4, 2e-3)));

}  // namespace
}  // namespace ebac::motion_guard_test
