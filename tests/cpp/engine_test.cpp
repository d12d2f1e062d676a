// The bridge to an engine: its mailbox between two threads, its answers in simulated time, blending and ageing.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <thread>

#include "ebac/world/engine/bridge.hpp"
#include "rounds.hpp"

namespace ebac::engine_test {
namespace {

using namespace ebac::world;

constexpr double kDt = 1e-3;  // s
const Axes kStill = Axes::Zero();

LocalModel plane(double at, double stiffness, double t = 0) {
  return {.at = {at, 0, 0}, .stiffness = stiffness, .t = t, .surface = true};
}
Axes at(double x) { return {x, 0, 0}; }

/// Answers with a plane that is elsewhere and of another stiffness each time.
class Restless final : public Engine {
 public:
  LocalModel answer(const Axes&, const Axes&, double t) EBAC_RT override {
    ++calls;
    LocalModel model = plane(1e-3 * random_.symmetric(), 2000 + 1500 * random_.symmetric(), t);
    model.into = Axes{1, 0.4 * random_.symmetric(), 0.4 * random_.symmetric()}.normalized();
    model.curvature = 20 * (1 + random_.symmetric());
    return model;
  }
  std::unique_ptr<Engine> fresh() const override { return std::make_unique<Restless>(); }
  int calls = 0;

 private:
  Noise random_{3};
};

TEST(LocalModel, ASphereIsAPlaneOfNoCurvatureAndABallOrAHollow) {
  const Axes x{0.003, 0.001, -0.002};
  for (const double radius : {0.02, 0.5, -0.02}) {
    LocalModel ball = plane(0, 1000);
    ball.curvature = 1 / radius;
    const Axes centre{radius, 0, 0};
    const double outside = (x - centre).norm() - std::abs(radius);
    const double exact = radius > 0 ? -outside : outside;
    EXPECT_NEAR(ball.depth(x, 0).d, exact, 1e-15);
    const Axes into = std::copysign(1.0, radius) * (centre - x).normalized();
    EXPECT_NEAR((ball.depth(x, 0).into - into).norm(), 0, 1e-12);
  }
  LocalModel flat = plane(0.001, 1000);
  flat.velocity = {0.1, 0, 0};
  EXPECT_NEAR(flat.depth(x, 0.01).d, 0.001, 1e-15);
}

TEST(ScheduledModels, CallsAtItsRateAndAnswersInOrderWhenDue) {
  auto engine = std::make_unique<Restless>();
  const Restless& counted = *engine;
  ScheduledModels models(std::move(engine), {.rate = 500, .compute = 0.004, .jitter = 0.01});
  double last = -1;
  double latest = 0;
  int answers = 0;
  for (int i = 0; i <= 1000; ++i) {
    const Answer* answer = models.take(at(0), kStill, i * kDt);
    if (answer == nullptr) continue;
    ++answers;
    EXPECT_GT(answer->model.t, last);
    last = answer->model.t;
    EXPECT_GE(i * kDt - last, 0.004 - 1e-6);
    EXPECT_LE(i * kDt - last, 0.014 + kDt);
    latest = std::max(latest, i * kDt - last);
  }
  EXPECT_EQ(counted.calls, 501);
  EXPECT_GT(answers, 150);
  EXPECT_GT(latest, 0.01);
  EXPECT_THROW(ScheduledModels(std::make_unique<Restless>(), {.rate = 1000, .jitter = 0.1}),
               std::invalid_argument);
}

TEST(BlendedModel, ANewModelMovesNoForceAtOnce) {
  BlendedModel surface({.blend = 0.02, .slew = 0.1});
  surface.receive(plane(0, 1000), at(-0.01), 0);
  Axes before = Axes::Zero();
  Noise random(1);
  Restless engine;
  for (int i = 1; i < 5000; ++i) {
    const double t = i * kDt;
    const Axes x = at(0.002);
    surface.advance(x, t, kDt);
    if (i % 7 == 0) surface.receive(engine.answer(x, kStill, t), x, t);
    const BlendedModel::Surface now = surface.meet(x);
    const Axes force = now.push * now.into;
    if (i > 1) {
      // 3.5 kN/m at 0.1 m/s, 3 kN/m of difference and a turn by 1 rad, a tick of 20 ms
      ASSERT_LT((force - before).norm(), 0.35 + (3000 * 0.004 + 14) * kDt / 0.02) << i;
    }
    before = force;
  }
}

TEST(BlendedModel, ASurfaceThatIsToldTooLateComesOutAtItsSpeed) {
  BlendedModel surface({.blend = 1e-3, .slew = 0.1});
  surface.receive(plane(0, 1000), at(0.005), 0);
  EXPECT_EQ(surface.meet(at(0.005)).push, 0);
  for (int i = 1; i <= 20; ++i) surface.advance(at(0.005), i * kDt, kDt);
  EXPECT_NEAR(surface.meet(at(0.005)).depth, 0.002, 1e-9);
  EXPECT_NEAR(surface.given(), 0.5 * 1000 * 0.002 * 0.002, 1e-9);
}

/// A surface that moved when the engine last saw it: that nothing is there any more moves no force at once either.
TEST(BlendedModel, AMovingSurfaceThatIsGoneDoesNotJump) {
  for (const double speed : {0.4, -0.4}) {
    BlendedModel surface({.blend = 1e-3, .slew = 0.1});
    LocalModel moving = plane(0, 10e3);
    moving.velocity = {speed, 0, 0};
    const auto push_at = [&](int tick) {
      const Axes x = at(speed * std::min(tick, 49) * kDt + 0.01);
      surface.advance(x, tick * kDt, kDt);
      return surface.meet(x).push;
    };
    surface.receive(moving, at(-0.01), 0);
    double before = push_at(0);
    for (int i = 1; i <= 100; ++i) {
      if (i >= 50 && i % 10 == 0) surface.receive({.t = (i - 5) * kDt}, at(0), (i - 1) * kDt);
      const double now = push_at(i);
      ASSERT_LE(std::abs(now - before), 10e3 * 0.1 * kDt + 1e-9) << speed << " " << i;
      before = now;
    }
    EXPECT_NEAR(before, 100 - 51, 1e-6);  // it stands, and goes at `slew`
  }
}

TEST(BlendedModel, ForceFadesWithAgeAndComesBack) {
  BlendedModel surface({.blend = 1e-3, .slew = 10, .stale = 0.1, .fade = 0.05});
  surface.receive(plane(0, 1000), at(-0.01), 0);
  const auto push_at = [&](int tick) {
    surface.advance(at(0.001), tick * kDt, kDt);
    return surface.meet(at(0.001)).push;
  };
  for (int i = 1; i <= 100; ++i) ASSERT_NEAR(push_at(i), 1, 1e-12);
  for (int i = 101; i < 150; ++i) ASSERT_NEAR(push_at(i), 1 - (i - 100) * kDt / 0.05, 1e-9);
  for (int i = 150; i < 300; ++i) ASSERT_NEAR(push_at(i), 0, 1e-9);
  surface.receive(plane(0, 1000, 0.299), at(0.001), 0.299);
  for (int i = 300; i < 345; ++i) ASSERT_NEAR(push_at(i), (i - 299) * kDt / 0.05, 1e-6);
}

TEST(Bridge, SaysHowOldItsModelsWereAndNeverForcesWithoutOne) {
  auto bridge = make_scheduled(std::make_unique<Restless>(), {.rate = 1, .compute = 0.5},
                               {.stale = 0.1, .fade = 0.1}, false);
  for (int i = 0; i < 500; ++i)
    ASSERT_EQ(bridge->contact(at(0.004), kStill, i * kDt).force.norm(), 0);
  for (int i = 500; i < 1000; ++i) bridge->contact(at(0.004), kStill, i * kDt);
  EXPECT_EQ(bridge->report().models(), 1);
  EXPECT_NEAR(bridge->report().oldest(), 0.999, 1e-9);
  EXPECT_GE(bridge->report().faded_at(), 0.5);
}

/// A spring that changes as it likes takes at least what it gives, but for what the bridge counts and what any sampled
/// spring leaks, K dx^2 / 2 a tick.
TEST(Bridge, CountsAllThatItsChangesCanGive) {
  for (std::int64_t seed = 1; seed <= rounds(20); ++seed) {
    auto bridge =
        make_scheduled(std::make_unique<Restless>(),
                       {.rate = 60, .compute = 0.01, .jitter = 0.02, .seed = seed}, {}, false);
    Noise random(static_cast<std::uint64_t>(seed));
    double phase = 0, work = 0, leak = 0;
    Axes x = at(-0.004), force = Axes::Zero();
    for (int i = 0; i < 3000; ++i) {
      phase += 0.03 * (1.2 + random.symmetric());
      const Axes next{0.004 * std::sin(phase), 0.002 * std::sin(0.7 * phase), 0};
      work += force.dot(next - x);
      leak += 0.5 * 3500 * (next - x).squaredNorm();
      x = next;
      force = bridge->contact(x, kStill, i * kDt).force;
      ASSERT_GE(work, -bridge->report().given() - leak - 1e-9) << seed << " " << i;
    }
    EXPECT_GT(bridge->report().given(), 0);
  }
}

TEST(EngineChannel, OneWorldAtATimeStandsAtTheTicksEnd) {
  const auto channel = std::make_shared<EngineChannel>();
  auto first = make_posted(channel, {});
  const auto second = first->fresh();
  channel->post(plane(0, 1000), at(0));
  EXPECT_EQ(second->contact(at(-0.001), kStill, 0).force.norm(), 0);
  EXPECT_EQ(first->contact(at(0.002), kStill, 0.001).force.norm(), 0);
  EXPECT_GT(second->contact(at(0.002), kStill, 0.01).force.norm(), 0);
}

TEST(EngineChannel, AnAnswerToAnEarlierRunIsNotTaken) {
  const auto channel = std::make_shared<EngineChannel>();
  const auto bridge = make_posted(channel, {});
  channel->post(plane(0, 1000, 30.0), at(0));  // it would be young for half a minute
  EXPECT_EQ(bridge->contact(at(0.002), kStill, 0).force.norm(), 0);
  EXPECT_EQ(bridge->contact(at(0.002), kStill, 0.1).force.norm(), 0);
  EXPECT_EQ(bridge->report().models(), 0);
}

/// What `bridge` makes of an answer whose bytes were damaged on the way [N].
template <class Damage>
double force_of_damaged(Damage damage) {
  const auto mail = std::make_shared<EngineMail>();
  const auto bridge = make_posted(std::make_shared<EngineChannel>(mail), {});
  bridge->contact(at(0), kStill, 0);
  Answer answer{.model = plane(0, 1000)};
  damage(answer);
  mail->models.post(answer);
  bridge->contact(at(-0.001), kStill, kDt);
  return bridge->contact(at(0.002), kStill, 2 * kDt).force.norm();
}

TEST(EngineChannel, ADamagedAnswerIsNoForceButAFault) {
  EXPECT_NEAR(force_of_damaged([](Answer&) {}), 2, 1e-12);
  using Change = void (*)(LocalModel&);
  const std::array<Change, 12> changes{
      [](LocalModel& m) { m.stiffness = 1e9; },
      [](LocalModel& m) { m.stiffness = -1; },
      [](LocalModel& m) { m.stiffness = NAN; },
      [](LocalModel& m) { m.damping = 1e5; },
      [](LocalModel& m) { m.damping = -1; },
      [](LocalModel& m) { m.into = {1e3, 0, 0}; },
      [](LocalModel& m) { m.into = kStill; },
      [](LocalModel& m) { m.at[1] = 1e6; },
      [](LocalModel& m) { m.velocity[2] = -1e3; },
      [](LocalModel& m) { m.curvature = 1e300; },
      [](LocalModel& m) { m.t = NAN; },
      [](LocalModel& m) { m.t = -INFINITY; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const double force = force_of_damaged([&](Answer& answer) { changes[i](answer.model); });
    EXPECT_TRUE(std::isnan(force)) << i << " " << force;
  }
}

/// A byte that is neither true nor false may become anything, also both.
TEST(EngineChannel, AnyByteIsASurfaceOrNone) {
  constexpr unsigned char kNeither = 0xFE;
  const auto mail = std::make_shared<EngineMail>();
  const auto bridge = make_posted(std::make_shared<EngineChannel>(mail), {});
  bridge->contact(at(-0.001), kStill, 0);
  mail->models.post({.model = plane(0, 1000)});
  auto* first_slot = reinterpret_cast<unsigned char*>(&mail->models);
  unsigned char& surface = first_slot[offsetof(Answer, model) + offsetof(LocalModel, surface)];
  ASSERT_EQ(surface, 1);
  surface = kNeither;
  bridge->contact(at(-0.001), kStill, kDt);
  EXPECT_NEAR(bridge->contact(at(0.002), kStill, 2 * kDt).force.norm(), 2, 1e-12);
}

/// The slot of an answer is the loop's only by agreement.
TEST(EngineChannel, AnAnswerThatIsWrittenOverIsTheOneThatWasChecked) {
  const auto mail = std::make_shared<EngineMail>();
  PostedModels models(std::make_shared<EngineChannel>(mail));
  mail->models.post({.model = plane(0, 1000)});
  const Answer* taken = models.take(at(0), kStill, 0);
  ASSERT_NE(taken, nullptr);
  for (int i = 0; i < 3; ++i) {  // as an engine that has lost count of the slots
    mail->models.post({.model = plane(0, 1e9)});
    mail->models.take();
  }
  EXPECT_EQ(taken->model.stiffness, 1000);
}

TEST(EngineChannel, ThreadsMeetWithoutWaiting) {
  const auto channel = std::make_shared<EngineChannel>();
  const auto bridge = make_posted(channel, {});
  std::atomic<bool> ends{false};
  std::thread engine([&] {
    EnginePose pose;
    while (!ends.load()) {
      if (const EnginePose* newest = channel->take_pose()) {
        EXPECT_EQ(newest->x[0], newest->t);  // of one tick, whole
        EXPECT_GE(newest->t, pose.t);
        pose = *newest;
      }
      channel->post(plane(0, 1000, pose.t), pose.x);
      std::this_thread::yield();
    }
  });
  int i = 0;
  while (i < 20'000 || (bridge->report().models() < 10 && i < 20'000'000)) {
    const double t = ++i * 1e-6;
    const ContactForce contact = bridge->contact(at(t), kStill, t);
    ASSERT_TRUE(std::isfinite(contact.force.sum()));
    ASSERT_GE(contact.force[0], 0);
  }
  ends = true;
  engine.join();
  EXPECT_GE(bridge->report().models(), 10);
}

}  // namespace
}  // namespace ebac::engine_test
