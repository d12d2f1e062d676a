#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "ebac/control/eba_account.hpp"
#include "ebac/control/ebac_shared.hpp"
#include "ebac/model/noise.hpp"

namespace ebac::energy_test {
namespace {

/// A world that is out for energy: displacements and forces of every size, walls, and now and then
/// the very displacement that takes the most out of the force that acts, -F/(2B).
class HostileWorld {
 public:
  HostileWorld(double b, std::uint64_t seed) : b_(b), random_(seed) {}

  double displacement(double acting) {
    switch (random_.bits() % 4) {
      case 0:
        return -acting / (2 * b_);
      case 1:
        return 0;
      default:
        return 1e-3 * random_.normal();
    }
  }
  double force(double x, double command) {
    switch (random_.bits() % 4) {
      case 0:
        return std::max(0.0, 1e4 * x);
      case 1:
        return -command;
      case 2:
        return 100 * random_.normal();
      default:
        return command;
    }
  }

 private:
  double b_;
  Noise random_;
};

/// Lowest of W + D over `steps` ticks of one law in a hostile world.
double least_energy(int delay, double damping, std::uint64_t seed, int steps) {
  const Timing timing{.dt = 1e-3, .delay = delay};
  EbaAccount law({.damping = damping, .current_lag = 0, .count = 0, .peak_force = 1e4}, timing);
  HostileWorld world(damping / timing.dt, seed);
  std::deque<double> queue(static_cast<std::size_t>(delay) + 1, 0.0);
  Port port;
  double energy = 0;
  double least = 0;
  law.step(port);
  for (int k = 0; k < steps; ++k) {
    const double acting = queue.front();
    queue.pop_front();
    port.dx = world.displacement(acting);
    port.x += port.dx;
    port.dt = timing.dt;
    port.f_applied = acting;
    port.f_env = world.force(port.x, port.f_cmd);
    energy += (acting + damping / timing.dt * port.dx) * port.dx;
    least = std::min(least, energy);
    port.f_cmd = law.step(port);
    queue.push_back(port.f_cmd);
  }
  return least;
}

class EbaBound : public testing::TestWithParam<int> {};

TEST_P(EbaBound, HoldsOverHundredsOfThousandsOfHostileSteps) {
  for (const double damping : {0.1, 2.0, 40.0}) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      EXPECT_GE(least_energy(GetParam(), damping, seed, 50'000), -1e-9)
          << "damping " << damping << " N s/m, seed " << seed;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Delay, EbaBound, testing::Values(0, 1, 2, 5));

/// With the observer a world tells how it moves when the command acts, `delay` ticks and a half ahead.
TEST(EbacShared, TakesTheMotionOfAWorldThatWasToldWithTheForceThatActs) {
  for (const int delay : {0, 1, 2, kMaxDelay}) {
    EbacShared shared(EbacParams{}, Timing{.delay = delay});
    shared.set_tick(1e-3);
    Port port;
    port.dt = 1e-3;
    port.est.weight = 1;
    for (int k = 0; k < 40; ++k) {
      port.world_v = k < 20 ? 0.1 * (1 + k) : 0;
      port.f_env = port.world_v == 0 ? 0 : -1 - k;
      const int told = k - delay - 1;
      const bool moved = 0 <= told && told < 20;
      EXPECT_NEAR(shared.surface(port), moved ? 0.1e-3 * (1 + told) : 0, 1e-15)
          << delay << " " << k;
      EXPECT_EQ(shared.asked[0], moved ? -1 - told : 0) << delay << " " << k;
      shared.give(0, port, 1e4);
    }
    port.est.weight = 0;  // where the world is met as it is now, as it moves now
    port.world_v = 0.2;
    EXPECT_NEAR(shared.surface(port), 0.1e-3, 1e-15);
  }
}

}  // namespace
}  // namespace ebac::energy_test
