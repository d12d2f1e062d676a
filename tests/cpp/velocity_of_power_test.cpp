// One velocity that stands for what several surfaces do: its power is theirs, unless they squeeze.
#include "ebac/model/velocity_of_power.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ebac/model/noise.hpp"

namespace ebac::velocity_of_power_test {
namespace {

Axes vector(Noise& random) { return {random.symmetric(), random.symmetric(), random.symmetric()}; }

TEST(VelocityOfPower, HasThePowerOfAllSurfacesWhereMoreThanAFifthOfTheirPushIsLeft) {
  Noise random(5);
  for (int run = 0; run < 1000; ++run) {
    const Axes f = vector(random), g = vector(random), v = vector(random), w = vector(random);
    const Axes force = f + g;
    const double pushes = f.norm() + g.norm(), power = f.dot(v) + g.dot(w);
    const Axes about = (f.norm() * v + g.norm() * w) / pushes;
    const Axes found = velocity_of_power(about, power, force, pushes);
    const double before = std::abs(power - force.dot(about));
    const double after = std::abs(power - force.dot(found));
    if (force.norm() > 0.2 * pushes) {
      ASSERT_LT(after, 1e-12);
    } else {
      ASSERT_LE(after, before + 1e-12);
    }
    ASSERT_LT(
        std::abs((found - about).norm() * force.norm() - std::abs((found - about).dot(force))),
        1e-12);  // no farther from the mean than it must
    ASSERT_LE((found - about).norm(), before / (0.2 * pushes) + 1e-12);
  }
}

TEST(VelocityOfPower, IsThatOfASingleSurface) {
  Noise random(6);
  const Axes f = vector(random), v = vector(random);
  EXPECT_EQ(velocity_of_power(v, f.dot(v), f, f.norm()), v);
  EXPECT_EQ(velocity_of_power(v, 0, Axes::Zero(), 0), v);
}

}  // namespace
}  // namespace ebac::velocity_of_power_test
