// Solids, the proxy on them, materials and scenes: what must hold for any of them.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "ebac/model/noise.hpp"
#include "ebac/world/scene.hpp"
#include "ebac/world/shapes.hpp"
#include "rounds.hpp"

namespace ebac::world_test {
namespace {

using namespace ebac::world;

template <class S>
SolidPtr solid(const S& shape) {
  return std::make_shared<SolidOf<S>>(shape);
}

Axes somewhere(Noise& random, double reach) {
  return {reach * random.symmetric(), reach * random.symmetric(), reach * random.symmetric()};
}

struct Named {
  std::string name;
  SolidPtr made;
  bool exact = true;  // outside: the distance, not only a bound of it
};

std::vector<Named> solids() {
  const SolidPtr box = solid(Box{.width = 0.05, .depth = 0.03, .height = 0.04});
  const SolidPtr ball = solid(Sphere{.radius = 0.02});
  const SolidPtr beside = std::make_shared<Placed>(
      ball, Axes{0.02, 0.01, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Axes::UnitX())));
  return {
      {"plane", solid(Plane{})},
      {"sphere", ball},
      {"box", box},
      {"cylinder", solid(Cylinder{.radius = 0.02, .length = 0.05})},
      {"capsule", solid(Capsule{.radius = 0.015, .length = 0.04})},
      {"torus", solid(Torus{.radius = 0.03, .tube = 0.01})},
      {"cavity", std::make_shared<Inverted>(box), false},
      {"union", std::make_shared<Union>(std::vector<SolidPtr>{box, beside})},
      {"difference",
       std::make_shared<Intersection>(
           std::vector<SolidPtr>{box, std::make_shared<Inverted>(beside)}),
       false},
      {"placed", beside},
  };
}

class EverySolid : public testing::TestWithParam<std::size_t> {
 protected:
  Named it_ = solids()[GetParam()];
};

TEST_P(EverySolid, ADistanceChangesByNoMoreThanTheWay) {
  Noise random(1);
  for (int i = 0; i < rounds(20'000); ++i) {
    const Axes a = somewhere(random, 0.06);
    const Axes b = i % 2 == 0 ? somewhere(random, 0.06) : Axes(a + somewhere(random, 1e-4));
    const double change = std::abs(it_.made->distance(a).d - it_.made->distance(b).d);
    ASSERT_LE(change, (a - b).norm() * (1 + 1e-9) + 1e-15);
  }
}

TEST_P(EverySolid, TheNormalIsTheDerivativeOfTheDistance) {
  Noise random(2);
  const double h = 1e-7;
  int compared = 0;
  for (int i = 0; i < rounds(5000); ++i) {
    const Axes x = somewhere(random, 0.06);
    const Distance at = it_.made->distance(x);
    ASSERT_NEAR(at.out.norm(), 1, 1e-12);
    Axes slope;
    for (int k = 0; k < 3; ++k) {
      const double more = it_.made->distance(x + h * Axes::Unit(k)).d;
      const double less = it_.made->distance(x - h * Axes::Unit(k)).d;
      slope[k] = (more - less) / (2 * h);
    }
    if (std::abs(slope.norm() - 1) > 1e-4) continue;  // on an edge or an axis of the shape
    ++compared;
    ASSERT_NEAR((slope - at.out).norm(), 0, 1e-4) << it_.name << " at " << x.transpose();
  }
  EXPECT_GT(compared, rounds(4500));
}

TEST_P(EverySolid, AStepOfTheDistanceNeverPassesTheSurface) {
  Noise random(3);
  for (int i = 0; i < rounds(5000); ++i) {
    const Axes x = somewhere(random, 0.06);
    const Distance at = it_.made->distance(x);
    if (at.d <= 0) continue;
    const Axes way = somewhere(random, 1).normalized();
    ASSERT_GE(it_.made->distance(x + 0.999 * at.d * way).d, -1e-12);
    if (it_.exact) {
      ASSERT_NEAR(it_.made->distance(x - at.d * at.out).d, 0, 1e-9);
    }
  }
}

TEST_P(EverySolid, TheProxyIsNeverInsideAndFreeOutside) {
  Noise random(4);
  Proxy proxy;
  Axes x = {0.08, 0.08, 0.08};
  if (it_.made->distance(x).d <= 0) x = Axes{-0.08, 0, 0};
  if (it_.made->distance(x).d <= 0) x = Axes::Zero();
  ASSERT_GT(it_.made->distance(x).d, 0);
  proxy.put(x);
  Axes v = Axes::Zero();
  int touched = 0;
  for (int i = 0; i < rounds(20'000); ++i) {
    v = 0.99 * v + 2e-5 * Axes{random.normal(), random.normal(), random.normal()} - 1e-5 * x;
    x += v;
    proxy.follow(*it_.made, x);
    ASSERT_GE(it_.made->distance(proxy.place()).d, -2 * Proxy::kExact) << it_.name << ", " << i;
    if (proxy.touching()) {
      ++touched;
      if ((x - proxy.place()).norm() > 4e-3) continue;  // far on its way round the solid
      ASSERT_NEAR(it_.made->distance(proxy.place()).d, 0, 1e-6);
    } else {
      ASSERT_EQ(proxy.place(), x);
      ASSERT_GE(it_.made->distance(x).d, -2 * Proxy::kExact);
    }
  }
  EXPECT_GT(touched, rounds(100));
}

INSTANTIATE_TEST_SUITE_P(, EverySolid, testing::Range<std::size_t>(0, solids().size()),
                         [](const auto& one) { return solids()[one.param].name; });

TEST(Material, HuntCrossleyIsItsEquation) {
  HuntCrossley tissue{.stiffness = 2e4, .exponent = 1.5, .dissipation = 0.4};
  for (const double x : {0.0, 1e-4, 2e-3, 1e-2}) {
    for (const double v : {-0.5, 0.0, 0.3}) {
      const double wanted = 2e4 * std::pow(x, 1.5) * (1 + 1.5 * 0.4 * v);
      EXPECT_NEAR(tissue.press(x, v).force, std::max(0.0, wanted), 1e-12);
    }
  }
}

TEST(Material, ALayerGivesWayAtItsThresholdAndHealsOnceLeft) {
  std::array<Layer, Layered::kMost> layers{};
  layers[0] = {.thickness = 2e-3, .stiffness = 1000, .puncture = 3, .cutting = 0.5};
  layers[1] = {.thickness = 10e-3, .stiffness = 300};
  Layered tissue(layers, 2);
  EXPECT_NEAR(tissue.press(2.9e-3, 0).force, 2.9, 1e-12);
  EXPECT_EQ(tissue.punctured(), 0U);
  EXPECT_NEAR(tissue.press(3.1e-3, 0.1).force, 0.5 + 300 * 1.1e-3, 1e-12);  // the drop
  EXPECT_EQ(tissue.punctured(), 1U);
  EXPECT_NEAR(tissue.press(2.9e-3, 0).force, 300 * 0.9e-3, 1e-12);  // it stays punctured
  tissue.reset();
  EXPECT_NEAR(tissue.press(2.9e-3, 0).force, 2.9, 1e-12);
}

Scene scene_of(const SolidPtr& made, double friction = 0, const Swing& motion = {}) {
  return Scene({Body(made, Elastic{.stiffness = 2000}, friction, motion)});
}

TEST(Scene, ABoxIsTheWall) {
  Scene scene =
      scene_of(std::make_shared<Placed>(solid(Box{.width = 1, .depth = 1, .height = 1}),
                                        Axes{0.51, 0, 0}, Eigen::Quaterniond::Identity()));
  scene.contact(Axes::Zero(), Axes::Zero(), 0);
  for (const double x : {0.0, 0.009, 0.011, 0.013}) {
    const ContactForce touch = scene.contact({x, 0, 0}, Axes::Zero(), 0);
    EXPECT_NEAR(touch.force[0], 2000 * std::max(0.0, x - 0.01), 1e-9);
    EXPECT_NEAR(touch.along[0], touch.force[0], 1e-9);
    EXPECT_FALSE(touch.turned);
  }
}

TEST(Scene, TheFrameIsOrthonormalAndGivesTheForce) {
  Noise random(5);
  for (const Named& one : solids()) {
    Scene scene = scene_of(one.made, 0.3);
    Axes x = {-0.08, 0.001, 0.002}, v = Axes::Zero();
    for (int i = 0; i < rounds(5000); ++i) {
      v = 0.99 * v + 2e-5 * Axes{random.normal(), random.normal(), random.normal()} - 1e-5 * x;
      x += v;
      const ContactForce touch = scene.contact(x, 1e3 * v, 1e-3 * i);
      ASSERT_NEAR((touch.frame * touch.frame.transpose() - Jacobian::Identity()).norm(), 0, 1e-9);
      ASSERT_NEAR((touch.frame.transpose() * touch.along - touch.force).norm(), 0, 1e-9);
    }
  }
}

TEST(Scene, FrictionSticksAndSlipsOnItsCone) {
  Scene scene = scene_of(solid(Plane{}), 0.5);
  double t = 0;
  Axes x = {-0.001, 0, 0};
  scene.contact(x, Axes::Zero(), t);
  for (int i = 0; i <= 20; ++i) scene.contact({1e-4 * i, 0, 0}, Axes::Zero(), t += 1e-3);
  const double push = 2000 * 0.002;
  for (int i = 0; i <= 40; ++i) {
    const ContactForce touch = scene.contact({0.002, 1e-4 * i, 0}, Axes::Zero(), t += 1e-3);
    EXPECT_NEAR(touch.force[0], push, 1e-9);
    EXPECT_NEAR(touch.force[1], std::min(0.5 * push, 2000 * 1e-4 * i), 1e-9);
  }
}

TEST(Scene, FrictionBeginsWhereAContactFromInsideDoes) {
  for (const Axes& x : {Axes{0.005, 0.02, 0}, Axes{0.005, -0.02, 0.01}}) {
    Scene scene = scene_of(solid(Plane{}), 0.5);
    EXPECT_NEAR((scene.contact(x, Axes::Zero(), 0).force - Axes{10, 0, 0}).norm(), 0, 1e-9);
    const ContactForce slid = scene.contact(x + Axes{0, 1e-3, 0}, Axes::Zero(), 1e-3);
    EXPECT_NEAR((slid.force - Axes{10, 2, 0}).norm(), 0, 1e-9);
    const ContactForce again = scene.fresh()->contact(-0.5 * x + Axes{0.01, 0, 0}, Axes::Zero(), 0);
    EXPECT_NEAR((again.force - Axes{15, 0, 0}).norm(), 0, 1e-9);
  }
}

TEST(Scene, AMovingBodyHasTheVelocityOfItsSurface) {
  const Swing motion{.amplitude_x = 0.002, .frequency = 2, .turn_z = 3};
  Scene scene = scene_of(solid(Sphere{.radius = 0.02}), 0, motion);
  const Axes x = {-0.019, 0.001, 0};
  scene.contact({-0.05, 0, 0}, Axes::Zero(), 0);
  for (int i = 0; i < 500; ++i) {
    const double t = 1e-3 * i;
    const ContactForce touch = scene.contact(x, Axes::Zero(), t);
    if (touch.depth == 0) continue;
    const BodyPose pose = motion.at(t);
    EXPECT_NEAR((touch.velocity - pose.velocity_at(x)).norm(), 0, 1e-12);
    EXPECT_NEAR(touch.depth, 0.02 - (x - pose.at).norm(), 1e-8);
  }
}

TEST(Scene, AFreshOneForgets) {
  std::array<Layer, Layered::kMost> layers{};
  layers[0] = {.thickness = 2e-3, .stiffness = 1000, .puncture = 1};
  Scene scene({Body(solid(Plane{}), Layered(layers, 1), 0, {})});
  const auto at = [](World& world, double x) {
    return world.contact({x, 0, 0}, Axes::Zero(), 0).force[0];
  };
  at(scene, -1e-3);
  EXPECT_EQ(at(scene, 5e-3), 0);  // punctured
  const auto another = scene.fresh();
  at(*another, -1e-3);
  EXPECT_NEAR(at(*another, 5e-4), 0.5, 1e-12);
  EXPECT_EQ(at(scene, 5e-4), 0);
}

}  // namespace
}  // namespace ebac::world_test
