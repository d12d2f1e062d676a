// The map between joints and handle against finite differences, and what it does to a mass.
#include "ebac/model/kinematics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "ebac/model/noise.hpp"
#include "ebac/model/pose.hpp"

namespace ebac::kinematics_test {
namespace {

constexpr double kStep = 1e-5;  // rad, of a central difference

/// Joint vectors inside the limits; joints beyond the axes in use are zero.
std::vector<Axes> samples(const Kinematics& k) {
  Noise random(7);
  std::vector<Axes> all(50, Axes::Zero());
  for (Axes& q : all) {
    for (int i = 0; i < axes(k); ++i) q[i] = stops(k)[i] * random.symmetric();
  }
  return all;
}

Axes unit(int i) { return Axes::Unit(i); }

class EachKinematics : public testing::TestWithParam<Kinematics> {
 protected:
  const Kinematics k_ = GetParam();
  const int n_ = axes(k_);
};

TEST_P(EachKinematics, InverseUndoesForward) {
  for (const Axes& q : samples(k_)) {
    ASSERT_TRUE(within_limits(k_, q));
    const Axes x = forward(k_, q);
    ASSERT_LT((inverse(k_, x) - q).head(n_).norm(), 1e-14);
  }
}

TEST_P(EachKinematics, LimitsAreChecked) {
  Axes q = Axes::Zero();
  q[n_ - 1] = 1.001 * stops(k_)[n_ - 1];
  EXPECT_FALSE(within_limits(k_, q));
  q[n_ - 1] = std::nan("");
  EXPECT_FALSE(within_limits(k_, q));
}

TEST_P(EachKinematics, JacobianIsTheDerivativeOfForward) {
  for (const Axes& q : samples(k_)) {
    const Jacobian j = jacobian(k_, q);
    for (int i = 0; i < n_; ++i) {
      const Axes column =
          (forward(k_, q + kStep * unit(i)) - forward(k_, q - kStep * unit(i))) / (2 * kStep);
      ASSERT_LT((column - j.col(i)).norm(), 1e-10);
    }
  }
}

TEST_P(EachKinematics, TransposeIsPowerConjugate) {
  const Axes f{3, -2, 1};
  const Axes dq{0.5, 1.5, n_ == 3 ? -0.9 : 0};
  for (const Axes& q : samples(k_)) {
    ASSERT_NEAR(transpose(k_, q, f).dot(dq), f.dot(jacobian(k_, q) * dq), 1e-14);
  }
}

/// Height against gravity: -x for Linear, z for a gimbal.
double height(const Kinematics& k, const Axes& q) {
  if (const auto* slide = std::get_if<SlidingGimbal>(&k)) return slide->forward(q)[2];
  if (const auto* gimbal = std::get_if<Gimbal>(&k)) return gimbal->height(q);
  return -forward(k, q).head(axes(k)).sum();
}

TEST_P(EachKinematics, WeightIsTheSlopeOfThePotential) {
  for (const Axes& q : samples(k_)) {
    const Axes tau = weight(k_, q, 2.5);
    for (int i = 0; i < n_; ++i) {
      const double rise = height(k_, q + kStep * unit(i)) - height(k_, q - kStep * unit(i));
      ASSERT_NEAR(tau[i], -2.5 * rise / (2 * kStep), 1e-9);
    }
  }
}

Pose at(const Kinematics& k, const Axes& q, const Axes& dq) { return pose(k, q, dq); }

TEST_P(EachKinematics, DriftIsTheRateOfTheJacobian) {
  const Axes dq{1.2, -0.7, n_ == 3 ? 0.9 : 0};
  for (const Axes& q : samples(k_)) {
    const Jacobian rate =
        (jacobian(k_, q + kStep * dq) - jacobian(k_, q - kStep * dq)) / (2 * kStep);
    ASSERT_LT((at(k_, q, dq).drift - rate * dq).norm(), 1e-9);
  }
}

/// Lagrange: d/dt (M dq) - 1/2 d/dq (dq^T M dq), at constant rates.
TEST_P(EachKinematics, CoriolisFollowsFromTheMassMatrix) {
  Axes dq{1.2, -0.7, n_ == 3 ? 0.9 : 0};
  if (n_ == 1) dq[1] = 0;
  const auto inertia = [&](const Axes& q) { return at(k_, q, dq).inertia; };
  for (const Axes& q : samples(k_)) {
    const Axes rate = (inertia(q + kStep * dq) - inertia(q - kStep * dq)) / (2 * kStep);
    Axes expected = rate.cwiseProduct(dq);
    for (int i = 0; i < n_; ++i) {
      const Axes slope =
          (inertia(q + kStep * unit(i)) - inertia(q - kStep * unit(i))) / (2 * kStep);
      expected[i] -= 0.5 * slope.dot(dq.cwiseProduct(dq));
    }
    ASSERT_LT((at(k_, q, dq).coriolis - expected).norm(), 1e-10);
  }
}

INSTANTIATE_TEST_SUITE_P(All, EachKinematics,
                         testing::Values(Kinematics{Linear{}},
                                         Kinematics{Linear{.axes = 3, .radius = 0.05}},
                                         Kinematics{Gimbal{}}, Kinematics{Gimbal{.radius = 0.3}},
                                         Kinematics{SlidingGimbal{}},
                                         Kinematics{SlidingGimbal{.slide_radius = 0.06}}));

/// The lever's mass moves on the sphere: its kinetic energy is that of the point in space.
TEST(Gimbal, InertiaIsThatOfAPointOnTheSphere) {
  const Gimbal k{};
  const Axes dq{0.8, -1.1, 0};
  for (const Axes& q : samples(k)) {
    const auto point = [&](const Axes& a) {
      return Axes{k.forward(a)[0], k.forward(a)[1], k.height(a)};
    };
    const Axes v = (point(q + kStep * dq) - point(q - kStep * dq)) / (2 * kStep);
    ASSERT_NEAR(v.squaredNorm(), pose(k, q, dq).inertia.dot(dq.cwiseProduct(dq)), 1e-10);
    ASSERT_NEAR(point(q).norm(), k.radius, 1e-15);
  }
}

TEST(SlidingGimbal, InItsMiddleIsTheGimbal) {
  const SlidingGimbal k{.slide_radius = 0.06};
  const Gimbal middle{};
  const Axes dq{0.8, -1.1, 0};
  for (const Axes& q : samples(middle)) {
    EXPECT_EQ(k.forward(q).head(2), middle.forward(q).head(2));
    EXPECT_EQ(k.forward(q)[2], middle.height(q) - middle.radius);
    EXPECT_EQ(pose(k, q, dq).inertia.head(2), pose(middle, q, dq).inertia.head(2));
    EXPECT_EQ(pose(k, q, dq).coriolis.head(2), pose(middle, q, dq).coriolis.head(2));
  }
}

TEST(SlidingGimbal, InertiaIsThatOfAPointInSpace) {
  const SlidingGimbal k{.slide_radius = 0.06};
  const Axes dq{0.8, -1.1, 1.7};
  for (const Axes& q : samples(k)) {
    const Axes v = (k.forward(q + kStep * dq) - k.forward(q - kStep * dq)) / (2 * kStep);
    ASSERT_NEAR(v.squaredNorm(), pose(k, q, dq).inertia.dot(dq.cwiseProduct(dq)), 1e-10);
  }
}

TEST(Gimbal, PointsOffTheSphereGoToItsRim) {
  const Gimbal k{};
  EXPECT_NEAR(k.inverse({0.2, 0, 0})[0], std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(k.inverse({0, -0.2, 0})[1], -std::numbers::pi / 2, 1e-12);
  EXPECT_TRUE(k.inverse({1, 1, 0}).allFinite());
}

}  // namespace
}  // namespace ebac::kinematics_test
