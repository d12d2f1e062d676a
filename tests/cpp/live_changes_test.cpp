#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "ebac/control/ebac.hpp"
#include "ebac/control/force_feedback.hpp"
#include "ebac/control/lag_compensator.hpp"
#include "ebac/control/law_type.hpp"
#include "ebac/control/per_axis.hpp"
#include "ebac/control/take_over.hpp"
#include "ebac/control/tca.hpp"
#include "ebac/loop/held_back_commands.hpp"
#include "ebac/loop/parameter_updates.hpp"
#include "ebac/model/noise.hpp"
#include "rounds.hpp"

namespace ebac::live_changes_test {
namespace {

using All = PerAxis<AnyLaw>;

/// A law on one axis in contact.
struct Pressing {
  All law;
  std::array<Axis, 1> axes{};

  explicit Pressing(const AnyLaw& first) : law(first) {
    axes[0].port.dx = 1e-5;
    axes[0].port.dt = 1e-3;
  }
  /// The command while the world asks for `f_env`.
  double meet(double f_env, double depth = 0) {
    axes[0].port.f_env = f_env;
    ContactForce contact = ContactForce::straight({f_env, 0, 0});
    contact.depth = depth;
    law.step(std::span(axes), contact);
    return axes[0].port.f_cmd;
  }
  void adopt(const AnyLaw& next) {
    auto all = All::replacement(next);
    law.adopt(all);
  }
};

AnyLaw tca(double peak = 40, int delay = 1) {
  return any_law(Tca(Tca::Params{.kp = 0, .peak_force = peak}, {.delay = delay}));
}

TEST(PerAxis, AnotherLawTakesOverWithoutAStepAndItsForceFadesIn) {
  Pressing pressing(tca());
  for (int i = 0; i < 10; ++i) pressing.meet(5);
  EXPECT_NEAR(pressing.meet(5), 5, 1e-9);
  pressing.adopt(tca(2, 2));
  EXPECT_DOUBLE_EQ(pressing.meet(5), 5);
  double before = 5;
  for (int i = 0; i < 50; ++i) {
    const double now = pressing.meet(5);
    EXPECT_LE(now, before);
    EXPECT_GE(now, before - 0.07);
    before = now;
  }
  EXPECT_NEAR(before, 2, 1e-9);
}

TEST(ForceFeedback, ADerivativeThatIsTurnedOnBeginsWithoutAKick) {
  ForceFeedback loop(0.1, 0, 5e-3);
  for (int i = 0; i < 10; ++i) loop.step(2, 0, 1e-3);
  loop.retune(0.1, 0.01, 5e-3);
  EXPECT_DOUBLE_EQ(loop.step(2, 0, 1e-3), 0.2);
  EXPECT_GT(loop.step(2.1, 0, 1e-3), 0.21);
}

TEST(PerAxis, GainsAloneActAtOnceAndKeepTheMemory) {
  Pressing pressing(tca());
  pressing.meet(5);
  pressing.adopt(tca(2));
  EXPECT_DOUBLE_EQ(pressing.meet(5), 2);
}

TEST(PerAxis, AnotherLawOfSeveralAxesBeginsWithItsReserveAndNoMore) {
  const auto law = [](double reserve) { return any_law(Ebac({.reserve = reserve})); };
  All laws(law(0.01));
  std::array<Axis, 2> axes{};
  ContactForce contact = ContactForce::straight({5, 5, 0});
  contact.shared = true;
  const auto energy = [&](std::size_t i) {
    return laws.state_table().find("energy")->number(laws.state(i));
  };
  const auto tick = [&](double dx) {
    for (Axis& axis : axes) {
      axis.port.dx = dx;
      axis.port.x += dx;
      axis.port.work += axis.port.f_applied * dx;
      axis.port.dt = 1e-3;
      axis.port.f_env = axis.port.f_applied = 5;
    }
    laws.step(std::span(axes), contact);
  };
  for (int i = 0; i < 20; ++i) tick(-5e-5);  // the port gives out energy
  ASSERT_LT(energy(0), 0.01);
  auto next = All::replacement(law(0.02));
  laws.adopt(next);
  tick(0);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_LE(energy(i), 0.02 + 1e-12) << i;
}

TEST(PerAxis, AWorldTenTimesAsStiffComesLittleByLittle) {
  Pressing pressing(tca(90));
  pressing.meet(6);
  pressing.law.meet_another({6, 0, 0}, {60, 0, 0});
  double before = pressing.meet(60);
  EXPECT_DOUBLE_EQ(before, 6);
  int ticks = 0;
  for (; before < 60 - 1e-9 && ticks < 2000; ++ticks) {
    const double now = pressing.meet(60);
    EXPECT_GE(now, before);
    EXPECT_LE(now, before + (before + 0.6) / 240);  // a factor e in 250 ticks
    EXPECT_EQ(pressing.axes[0].port.f_env, 60);     // what the world asks for is recorded
    before = now;
  }
  EXPECT_GT(ticks, 500);
  EXPECT_LT(ticks, 600);  // 0.25 s ln(10)
}

TEST(PerAxis, ALawTakesAShareThatGrowsForNoMotion) {
  const LagCompensator slow({.virtual_damping = 0, .recovery_time = 10, .peak_force = 90});
  Pressing pressing(any_law(slow));
  pressing.axes[0].port.dx = 1;  // all of the force at once
  pressing.meet(6);
  pressing.axes[0].port.dx = 0;
  pressing.law.meet_another({6, 0, 0}, {60, 0, 0});
  EXPECT_NEAR(pressing.meet(60), 6, 1e-9);
  for (int i = 0; i < 250; ++i) pressing.meet(60);
  EXPECT_NEAR(pressing.meet(60), 6.6 * std::exp(1) - 0.6, 0.1);
}

TEST(PerAxis, ALawTakesAWorldThatBecomesSofterForNoMotion) {
  const LagCompensator slow({.virtual_damping = 0, .recovery_time = 10, .peak_force = 90});
  Pressing pressing(any_law(slow));
  pressing.axes[0].port.dx = 1;
  pressing.meet(60);
  pressing.axes[0].port.dx = 0;
  pressing.law.meet_another({60, 0, 0}, {6, 0, 0});
  EXPECT_NEAR(pressing.meet(6), 60, 1e-9);
  for (int i = 0; i < 50; ++i) pressing.meet(6);
  EXPECT_NEAR(pressing.meet(6), 6, 1e-9);
}

TEST(PerAxis, ALawThatFollowsASofterOneBeginsAsSoft) {
  Pressing pressing(tca(6));
  for (int i = 0; i < 400; ++i) pressing.meet(60);  // gives 6
  pressing.adopt(tca(90, 2));
  EXPECT_DOUBLE_EQ(pressing.meet(60), 6);
  for (int i = 0; i < 60; ++i) pressing.meet(60);
  EXPECT_LT(pressing.meet(60), 10);
}

TEST(PerAxis, APushOfASmallForceIsShownWhole) {
  Pressing pressing(tca());
  pressing.meet(0);
  pressing.law.meet_another({0, 0, 0}, {3, 0, 0});
  pressing.meet(3, 1);  // a soft wall far behind
  for (int i = 0; i < 50; ++i) pressing.meet(3, 1);
  EXPECT_DOUBLE_EQ(pressing.meet(3, 1), 3);
}

TEST(PerAxis, WhatThrowsNobodyIsShownWhole) {
  Pressing pressing(tca());
  pressing.meet(0);
  pressing.law.meet_another({0, 0, 0}, {10, 0, 0});
  EXPECT_EQ(pressing.meet(10, 0.1e-3), 0);  // 0.5 mJ; the command passes all the same
  for (int i = 0; i < 50; ++i) pressing.meet(10, 0.1e-3);
  EXPECT_DOUBLE_EQ(pressing.meet(10, 0.1e-3), 10);
}

TEST(PerAxis, ASliderThatIsMovedTakesNothingFromAHandThatComesIn) {
  Pressing pressing(tca());
  double f = 0;
  for (int tick = 0; tick < 100; ++tick) {
    if (tick % 8 == 0) pressing.law.meet_another({f, 0, 0}, {1.001 * f, 0, 0});
    f += 0.3;
    EXPECT_NEAR(pressing.meet(f), f, 2.2);  // the way of seven ticks: each step fades slowly
  }
}

TEST(PerAxis, ASliderThatIsMovedToAndFroTakesNothingFromAHandAtRest) {
  Pressing pressing(tca());
  pressing.meet(10);
  for (int change = 0; change < 100; ++change) {
    const double before = change % 2 == 0 ? 10 : 13;
    const double now = 23 - before;
    pressing.law.meet_another({before, 0, 0}, {now, 0, 0});
    for (int tick = 0; tick < 16; ++tick) EXPECT_GE(pressing.meet(now), 10 - 1e-9);
  }
}

TEST(PerAxis, WhileAWorldTakesOverTheForceNeverPullsIntoIt) {
  Noise random(6);
  for (int run = 0; run < rounds(200); ++run) {
    Pressing pressing(tca());
    double before = 20 * std::abs(random.symmetric());
    for (int change = 0; change < 5; ++change) {
      pressing.meet(before);
      const double now = 20 * std::abs(random.symmetric());
      pressing.law.meet_another({before, 0, 0}, {now, 0, 0});
      for (int i = 0; i < 40; ++i) {
        before = 20 * std::abs(random.symmetric());
        EXPECT_GE(pressing.meet(before), 0);
      }
    }
  }
}

TEST(TakeOver, OfALawThatSwingsItCountsWhatThatGaveAtMost) {
  TakeOver take_over;
  std::array<Axis, 1> axes{};
  axes[0].port.f_env = 60;
  axes[0].port.dt = 1e-3;
  for (int tick = 0; tick < 300; ++tick) {
    axes[0].port.f_cmd = tick % 20 < 10 ? 60 : 0;
    take_over.watch(axes);
  }
  take_over.law();
  EXPECT_GT(take_over.shown(ContactForce::straight({60, 0, 0}), axes).force[0], 45);
}

TEST(PerAxis, AfterAContactIsLostTheNextOneIsWhole) {
  Pressing pressing(tca(90));
  pressing.meet(6);
  pressing.law.meet_another({6, 0, 0}, {60, 0, 0});
  for (int i = 0; i < 20; ++i) pressing.meet(60);
  EXPECT_LT(pressing.meet(60), 10);
  EXPECT_LT(pressing.meet(30), 5);
  EXPECT_EQ(pressing.meet(0), 0);
  EXPECT_EQ(pressing.meet(60), 60);
}

TEST(PerAxis, WhileALawTakesOverTheCommandLiesBetweenThatBeforeAndThatOfTheWorld) {
  Noise random(5);
  for (int run = 0; run < rounds(200); ++run) {
    Pressing pressing(tca());
    const double from = pressing.meet(20 * random.symmetric());
    pressing.adopt(tca(40, 2));
    for (int i = 0; i < 80; ++i) {
      const double wanted = 20 * random.symmetric();
      const double now = pressing.meet(wanted);
      EXPECT_GE(now, std::min({from, wanted, 0.0}) - 1e-9);
      EXPECT_LE(now, std::max({from, wanted, 0.0}) + 1e-9);
    }
  }
}

/// Notes that its world was changed.
struct Chain {
  int changed = 0;
  void change(const Environment&) EBAC_RT { ++changed; }
  static ContactForce contact(double, std::span<Axis>) EBAC_RT { return {}; }
  void act(bool) EBAC_RT {}
};

TEST(ParameterUpdates, AnotherWorldMakesNoStepOfTheForce) {
  Pressing pressing(tca());
  ParameterUpdates<All> updates(tca());
  Chain chain;
  int device = 0;
  pressing.meet(5);
  updates.post(Environment(Free{}));
  updates.apply(1, pressing.law, chain, device, pressing.axes, 0);
  EXPECT_EQ(chain.changed, 1);
  EXPECT_DOUBLE_EQ(pressing.meet(0), 5);
  for (int i = 0; i < 24; ++i) pressing.meet(0);
  EXPECT_NEAR(pressing.meet(0), 2.5, 1e-9);
  for (int i = 0; i < 24; ++i) pressing.meet(0);
  EXPECT_NEAR(pressing.meet(0), 0, 1e-9);
}

/// Remembers the last current it was given.
struct Given {
  double* current;
  Reading exchange(const Command& command) EBAC_RT {
    *current = command.current[0];
    return {};
  }
};

TEST(HeldBackCommands, ComeSoManyTicksLater) {
  double given = 0;
  HeldBackCommands<Given> device(Given{&given});
  const auto tick = [&](double current) {
    device.exchange({.current = {current}, .elapsed = 1e-3});
    return given;
  };
  EXPECT_EQ(tick(1), 1);
  device.hold_back(2);
  tick(2);
  EXPECT_EQ(tick(3), 1);
  EXPECT_EQ(tick(4), 2);
  device.hold_back(0);
  EXPECT_EQ(tick(5), 5);
  device.hold_back(99);
  for (int i = 6; i < 20; ++i) tick(i);
  EXPECT_EQ(given, 19 - 7);
}

}  // namespace
}  // namespace ebac::live_changes_test
