// The gastroscope's parts: kinematics against finite differences, slack, the wall, limits of motors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "ebac/gastroscope/slave.hpp"
#include "ebac/model/noise.hpp"

namespace ebac::gastroscope {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kTick = 1e-3;  // s

PatientParams still() {
  PatientParams patient;
  patient.breathing = patient.peristalsis = patient.antral_depth = 0;
  return patient;
}

TEST(BendingSection, JacobianIsThatOfTheKinematics) {
  constexpr double kLength = 0.07, kTip = 0.012, kStep = 1e-6;
  Noise random(3);
  for (int i = 0; i < 200; ++i) {
    const double large = i % 4 == 0 ? 1e-3 : 2.5;  // also where the series is used
    const Bend bend{large * random.symmetric(), large * random.symmetric()};
    const CameraJacobian j = jacobian_of(bend, kLength, kTip);
    for (const std::size_t column : {2U, 3U}) {
      const double dx = column == 2 ? kStep : 0, dy = column == 3 ? kStep : 0;
      const Vec more = camera_of({bend.x + dx, bend.y + dy}, kLength, kTip).at;
      const Vec less = camera_of({bend.x - dx, bend.y - dy}, kLength, kTip).at;
      EXPECT_LT(norm(j[column] - (0.5 / kStep) * (more - less)), 2e-9);
    }
    const Vec at = camera_of(bend, kLength, kTip).at;
    EXPECT_LT(norm(j[1] - cross({0, 0, 1}, at)), 1e-15);  // rotation about the tube
  }
}

TEST(BendingSection, IsAnArcOfItsLength) {
  const Bend bend{1.1, -0.7};
  double length = 0;
  Vec before{};
  for (int i = 1; i <= 2000; ++i) {
    const Vec at = point_of(bend, 0.07, i / 2000.0).at;
    length += norm(at - before);
    before = at;
  }
  EXPECT_NEAR(length, 0.07, 1e-8);
}

TEST(Tendon, CrossesItsSlackAfterEveryTurn) {
  Tendon tendon;
  const auto to = [&](double motor) { return tendon.follow(motor, 0.3, 0, 0.2); };
  EXPECT_EQ(to(0.15), 0);
  EXPECT_DOUBLE_EQ(to(0.5), 0.35);
  EXPECT_DOUBLE_EQ(to(0.25), 0.35);  // back through the slack: nothing moves
  EXPECT_DOUBLE_EQ(to(0.1), 0.25);
}

TEST(Tendon, FrictionLosesWorkAndDoesNotDependOnSpeed) {
  const auto loop = [](int steps) {
    Tendon tendon;
    double area = 0, before = 0;
    for (int i = 0; i <= 2 * steps; ++i) {
      const double motor = std::sin(kTurn * i / steps);
      const double bend = tendon.follow(motor, 0.1, 0.15, 0.2);
      if (i > steps) area += motor * (bend - before);  // the second time around
      before = bend;
    }
    return area;
  };
  EXPECT_GT(loop(4000), 0.1);
  EXPECT_NEAR(loop(4000), loop(40000), 4e-3);
}

TEST(Lumen, DepthOfABallInAStraightTube) {
  const std::vector<Vec> points{{0, 0, 0}, {-0.1, 0, 0}, {-0.2, 0, 0}};
  const Lumen lumen(still(), points, {0.012, 0.012, 0.012}, nullptr);
  Along hint;
  for (double y : {0.0, 5e-3, 0.011, 0.02}) {
    const WallNear wall = lumen.near({-0.13, y, 0}, 4e-3, {}, hint);
    EXPECT_NEAR(wall.depth, y + 4e-3 - 0.012, 1e-15);
    EXPECT_NEAR(wall.s, 0.13, 1e-15);
  }
}

// With the displacement of the last station the wall of a pushed stomach came in steps of 5 mm.
TEST(Lumen, DepthDoesNotJumpWhereTheStomachIsPushed) {
  const Lumen lumen(still());
  const LumenMotion pushed{.bag = {0.01, 0, 0}};
  Along hint{.station = 80};
  double before = NAN, jump = 0;
  for (double s = 0.41; s < 0.5; s += 2e-5) {
    const double depth = lumen.near(lumen.middle(s, pushed), 4.6e-3, pushed, hint).depth;
    if (!std::isnan(before)) jump = std::max(jump, std::abs(depth - before));
    before = depth;
  }
  EXPECT_LT(jump, 2e-4);
}

/// A place around the centre line, up to `most` of the radius from it.
Vec around(const Lumen& lumen, double s, double angle, double share) {
  const Frame frame = lumen.frame(s);
  const Vec out = std::cos(angle) * frame.x + std::sin(angle) * frame.y;
  return lumen.middle(s, {}) + share * lumen.radius(s, 0) * out;
}

// With a segment of its own slope and radius at a time the depth jumped by 1.1 mm behind the
// stomach, and the wall pushed with 6.6 N for a tick instead of 3.3.
TEST(Lumen, DepthDoesNotJumpFromSegmentToSegment) {
  const Lumen lumen(still());
  constexpr double kStep = 2e-5;  // m
  for (double angle = 0; angle < kTurn; angle += 0.3) {
    Along hint{.station = 6};
    double before = NAN, jump = 0;
    for (double s = 0.03; s < lumen.landmarks().end - 6e-3; s += kStep) {
      // Along a straight line beside the centre line, from one section of it to the next.
      const double begin = 5e-3 * std::floor(s / 5e-3), share = (s - begin) / 5e-3;
      const Vec from = around(lumen, begin, angle, 1.05);
      const Vec x = from + share * (around(lumen, begin + 5e-3, angle, 1.05) - from);
      const double depth = lumen.near(x, 4.6e-3, {}, hint).depth;
      if (!std::isnan(before)) jump = std::max(jump, std::abs(depth - before));
      before = depth;
    }
    EXPECT_LT(jump, 2e-4) << angle;
  }
}

TEST(Lumen, WayIsTheGradientOfTheDepth) {
  const Lumen lumen(still());
  constexpr double kStep = 1e-7;  // m
  Noise random(5);
  for (int i = 0; i < 500; ++i) {
    const double s = 0.36 + 0.34 * random.symmetric();
    const Vec x = around(lumen, s, 3.1 * random.symmetric(), 0.6 + 0.5 * random.symmetric());
    Along hint{.station = static_cast<int>(s / 5e-3)};
    const Vec way = lumen.near(x, 0, {}, hint).way;
    for (const Vec& step : {Vec{kStep, 0, 0}, Vec{0, kStep, 0}, Vec{0, 0, kStep}}) {
      const double more = lumen.near(x + step, 0, {}, hint).depth;
      const double less = lumen.near(x - step, 0, {}, hint).depth;
      EXPECT_NEAR((more - less) / (2 * kStep), dot(way, step) / kStep, 2e-4) << s;
    }
  }
}

TEST(Slave, PushesNoHarderAndGoesNoFasterThanItsMotor) {
  const Lumen lumen(still());
  const ScopeParams scope;
  Slave slave(scope, lumen, 0.65);  // before the pylorus, which straight tendons do not pass
  const double begin = slave.inserted();
  double push = 0;
  for (int i = 1; i <= 10000; ++i) {
    push = slave.step({.insertion = 1.5}, i * kTick, kTick).push;
    ASSERT_LT(push, scope.most_push + 1e-6);
    ASSERT_LT(slave.inserted() - begin, scope.insertion_speed * i * kTick + 1e-9);
  }
  EXPECT_NEAR(push, scope.most_push, 1e-6);
}

TEST(Slave, BendsNoFasterAndNoFartherThanItMay) {
  const std::vector<Vec> line{{0, 0, 0}, {-0.5, 0, 0}, {-1, 0, 0}};
  const Lumen lumen(still(), line, {0.3, 0.3, 0.3}, nullptr);  // free of the wall
  const ScopeParams scope;
  Slave slave(scope, lumen, 0.1);
  for (int i = 1; i <= 3000; ++i) {
    slave.step({.insertion = 0.018, .bend_x = 9, .bend_y = 9}, i * kTick, kTick);
    ASSERT_LT(std::abs(slave.bend().x), scope.bend_speed * i * kTick + 1e-9);
    ASSERT_LT(std::hypot(slave.bend().x, slave.bend().y), scope.most_bend + 1e-9);
  }
  EXPECT_GT(slave.bend().x, 1);
}

/// The section's force from second 9 to 10, with motors that bend it into the wall for 4 s and then
/// stand.
struct Held {
  double least = 1e9, most = 0;  // N
};
Held held(const PatientParams& patient, double dt) {
  const Lumen lumen(patient);
  Slave slave({}, lumen, 0.2);
  const double base = slave.insertion();
  Held held;
  for (int i = 1; i * dt <= 10; ++i) {
    const double t = i * dt;
    slave.step({.insertion = base, .bend_x = 0.6 * std::min(1.0, t / 4)}, t, dt);
    if (t < 9) continue;
    held.least = std::min(held.least, slave.section_force());
    held.most = std::max(held.most, slave.section_force());
  }
  return held;
}

// With the wall's damping and its slope outside of the steps the force swung by up to 22 N, and by
// more the shorter the tick.
TEST(Slave, ComesToRestInTheWallWhereItsMotorsStand) {
  for (double damping : {0.0, 2.0, 4.0, 10.0, 30.0}) {
    for (double stiffness : {200.0, 400.0, 800.0, 3000.0}) {
      for (double dt : {2e-3, 1e-3, 0.5e-3, 0.25e-3}) {
        PatientParams patient = still();
        patient.damping = damping;
        patient.stiffness = stiffness;
        const Held force = held(patient, dt);
        EXPECT_LT(force.most - force.least, 0.1) << damping << ' ' << stiffness << ' ' << dt;
        EXPECT_GT(force.least, 1) << damping << ' ' << stiffness << ' ' << dt;
      }
    }
  }
}

// While it slides along walls, too: the tube was looked at every ten ticks, and bounced.
TEST(Slave, MovesAlikeWithEveryTick) {
  const Lumen lumen(still());
  struct Found {
    double most = 0, mean = 0;  // N
  };
  const auto moved = [&](double dt) {
    Slave slave({}, lumen, 0.2);
    const double base = slave.insertion();
    Found found;
    for (int i = 1; i * dt <= 6; ++i) {
      const double t = i * dt;
      slave.step({.insertion = base + 0.03 * t,
                  .bend_x = 0.5 * std::sin(2 * t),
                  .bend_y = 0.5 * std::cos(1.3 * t) - 0.5},
                 t, dt);
      found.most = std::max(found.most, slave.section_force());
      found.mean += dt / 6 * slave.section_force();
    }
    return found;
  };
  const Found usual = moved(kTick);
  for (double dt : {2e-3, 0.5e-3, 0.125e-3}) {
    EXPECT_NEAR(moved(dt).most, usual.most, 0.1) << dt;
    EXPECT_NEAR(moved(dt).mean, usual.mean, 0.02) << dt;
  }
}

TEST(Slave, RestsAlikeWithEveryTickAndDamping) {
  PatientParams patient = still();
  const double usual = held(patient, kTick).most;
  EXPECT_NEAR(held(patient, 0.1e-3).most, usual, 0.1);
  patient.damping = 10;
  EXPECT_NEAR(held(patient, kTick).most, usual, 0.1);
}

// Only the tube came to rest before the start: in the pharynx the section lay up to 60 mm in the
// wall, and was perforated in the first tick.
TEST(Slave, LiesAtRestInTheWallWhereItStarts) {
  const Lumen lumen(still());
  for (double start = 0.09; start < 0.6; start += 0.01) {
    Slave slave({}, lumen, start);
    const double at_first = slave.section_force(), base = slave.insertion();
    EXPECT_NEAR(slave.inserted(), start, 5e-3) << start;
    for (int i = 1; i <= 1000; ++i) {
      slave.step({.insertion = base}, i * kTick, kTick);
      ASSERT_NEAR(slave.section_force(), at_first, 0.05) << start << ' ' << i;
    }
  }
}

TEST(Slave, AnInsertionThatIsNoNumberLeavesTheTubeAsLongAsItMayBe) {
  const Lumen lumen(still());
  Slave slave({}, lumen, 0.2);
  for (int i = 0; i < 3; ++i) slave.carry({.insertion = std::nan("")}, i * kTick, kTick);
  EXPECT_LE(slave.tube().nodes(), InsertionTube::kMost);
}

TEST(MotorAxis, StandsStillAtItsLoadAndIsNotPushedBack) {
  MotorAxis motor{.at = 1};
  for (double load : {2.0, 5.0}) motor.step(2, load, 0.03, 1, 2, kTick);
  EXPECT_EQ(motor.at, 1);
  motor.step(2, 1, 0.03, 1, 2, kTick);
  EXPECT_DOUBLE_EQ(motor.at, 1 + 0.5 * kTick);  // half the load, half the speed
  motor.step(0, 2, 0.03, 1, 2, kTick);
  EXPECT_DOUBLE_EQ(motor.at, 1 - 0.5 * kTick);  // with the load
}

}  // namespace
}  // namespace ebac::gastroscope
