// The proxy on solids: what it holds, where it lets go, and what it costs.
#include "ebac/world/proxy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "ebac/world/combined.hpp"
#include "ebac/world/shapes.hpp"

namespace ebac::world_test {
namespace {

using namespace ebac::world;

template <class S>
SolidPtr solid(const S& shape) {
  return std::make_shared<SolidOf<S>>(shape);
}

TEST(Proxy, HoldsAtAPlateThinnerThanTheHandleIsDeep) {
  const auto plate = solid(Box{.width = 0.002, .depth = 0.1, .height = 0.1});
  Proxy proxy;
  proxy.put({-0.02, 0, 0});
  for (int i = 0; i <= 200; ++i) proxy.follow(*plate, {-0.02 + 3e-4 * i, 1e-4 * i, 0});
  EXPECT_NEAR(proxy.place()[0], -0.001, 1e-9);
  EXPECT_NEAR(proxy.place()[1], 0.02, 1e-9);
}

TEST(Proxy, IsHeldByThreePlanesInACorner) {
  const Inverted room(solid(Box{.width = 0.2, .depth = 0.2, .height = 0.2}));
  Proxy proxy;
  proxy.put(Axes::Zero());
  for (int i = 0; i <= 300; ++i) proxy.follow(room, {4e-4 * i, 4.1e-4 * i, 4.2e-4 * i});
  EXPECT_EQ(proxy.constraints(), 3);
  EXPECT_NEAR((proxy.place() - Axes::Constant(0.1)).norm(), 0, 1e-8);
  for (int i = 300; i >= 0; --i) proxy.follow(room, {4e-4 * i, 4.1e-4 * i, 4.2e-4 * i});
  EXPECT_FALSE(proxy.touching());
}

/// Two half spaces whose normals are `angle` [rad] apart: a groove along z at x = 0.
class Groove final : public Solid {
 public:
  explicit Groove(double angle)
      : left_(-std::cos(angle / 2), std::sin(angle / 2), 0),
        right_(-std::cos(angle / 2), -std::sin(angle / 2), 0) {}
  Distance distance(const Axes& x) const EBAC_RT override {
    const double left = left_.dot(x), right = right_.dot(x);
    return left < right ? Distance{left, left_} : Distance{right, right_};
  }
  /// The point of the surface nearest to a handle inside.
  Axes nearest(const Axes& x) const {
    const Axes on_left = x - left_.dot(x) * left_, on_right = x - right_.dot(x) * right_;
    if (right_.dot(on_left) >= 0) return on_left;
    return left_.dot(on_right) >= 0 ? on_right : Axes(0, 0, x[2]);
  }

 private:
  Axes left_, right_;
};

TEST(Proxy, IsHeldByBothFacesOfAShallowGroove) {
  for (const double degrees : {1.0, 3.0, 10.0, 20.0, 25.0, 30.0, 60.0}) {
    const Groove groove(degrees * std::numbers::pi / 180);
    Proxy proxy;
    proxy.put({-0.01, 0.002, 0});
    for (int i = 0; i < 4000; ++i) {
      const Axes x{std::min(0.001, -0.01 + 2e-5 * i), 5e-4 * std::sin(6e-3 * i), 0};
      proxy.follow(groove, x);
      if (!proxy.touching()) continue;
      ASSERT_NEAR((proxy.place() - groove.nearest(x)).norm(), 0, 1e-6) << degrees << " degrees";
    }
  }
}

TEST(Proxy, FollowsASphereAtItsNearestPoint) {
  const auto ball = solid(Sphere{.radius = 0.02});
  Proxy proxy;
  proxy.put({0.03, 0, 0});
  for (int i = 0; i < 20'000; ++i) {
    const double a = 5e-4 * i;
    const Axes way = Axes{std::cos(a), 0.8 * std::sin(a), 0.6 * std::sin(a)};
    proxy.follow(*ball, (0.019 + 8e-4 * std::sin(0.01 * i)) * way);
    ASSERT_TRUE(proxy.touching());
    ASSERT_NEAR((proxy.place() - 0.02 * way).norm(), 0, 1e-6);
  }
}

/// A solid that counts how often it is asked.
class Counted final : public Solid {
 public:
  explicit Counted(SolidPtr solid) : solid_(std::move(solid)) {}
  Distance distance(const Axes& x) const EBAC_RT override {
    ++asked;
    return solid_->distance(x);
  }
  mutable int asked = 0;

 private:
  SolidPtr solid_;
};

TEST(Proxy, SlidesOverABallByOneDistanceATick) {
  constexpr double kRadius = 0.012, kDepth = 1e-3;
  const Counted ball(solid(Sphere{.radius = kRadius}));
  Proxy proxy;
  proxy.put({kRadius + kDepth, 0, 0});
  const int ticks = 20'000;
  for (int i = 0; i < ticks; ++i) {
    const double t = 2 * std::numbers::pi * i / ticks;  // up to 70 um a tick
    const Axes way{std::cos(3 * t) * std::cos(5 * t), std::sin(3 * t) * std::cos(5 * t),
                   std::sin(5 * t)};
    proxy.follow(ball, (kRadius - kDepth * (1 + 0.5 * std::sin(9 * t))) * way);
    if (i > 5) ASSERT_NEAR((proxy.place() - kRadius * way).norm(), 0, 10e-9) << i;
  }
  EXPECT_LT(ball.asked, 1.1 * ticks);
}

TEST(Proxy, LetsGoOverAnEdge) {
  const auto box = solid(Box{});
  Proxy proxy;
  for (int i = 0; i < 200; ++i) proxy.follow(*box, {-0.03 + 1e-4 * i, 0.0195, 0});
  EXPECT_NEAR(proxy.place()[0], -0.02, 1e-9);
  for (int i = 0; i < 40; ++i) proxy.follow(*box, {-0.0101, 0.0195 + 1e-4 * i, 0});
  EXPECT_FALSE(proxy.touching());
}

}  // namespace
}  // namespace ebac::world_test
