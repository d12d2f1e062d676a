#include <gtest/gtest.h>

#include <array>

#include "ebac/control/law_type.hpp"
#include "ebac/control/per_axis.hpp"
#include "ebac/control/tca.hpp"
#include "ebac/loop/held_back_commands.hpp"
#include "ebac/loop/parameter_updates.hpp"

namespace ebac::live_changes_test {
namespace {

using All = PerAxis<AnyLaw>;

Axis pressing(double f_env) {
  Axis axis;
  axis.port.dx = 1e-5;
  axis.port.dt = 1e-3;
  axis.port.f_env = f_env;
  return axis;
}

TEST(PerAxis, AnotherLawTakesOverWithoutAStepAndItsForceFadesIn) {
  All law(any_law(Tca(Tca::Params{.kp = 0})));
  std::array<Axis, 1> axes{pressing(5)};
  for (int i = 0; i < 10; ++i) law.step(std::span(axes), ContactForce{});
  EXPECT_NEAR(axes[0].port.f_cmd, 5, 1e-9);
  auto next = All::replacement(any_law(Tca(Tca::Params{.kp = 0, .peak_force = 2}, {.delay = 2})));
  law.adopt(next);
  law.step(std::span(axes), ContactForce{});
  EXPECT_DOUBLE_EQ(axes[0].port.f_cmd, 5);
  double before = 5;
  for (int i = 0; i < 50; ++i) {
    law.step(std::span(axes), ContactForce{});
    EXPECT_LE(axes[0].port.f_cmd, before);
    EXPECT_GE(axes[0].port.f_cmd, before - 0.07);
    before = axes[0].port.f_cmd;
  }
  EXPECT_DOUBLE_EQ(axes[0].port.f_cmd, 2);
}

TEST(PerAxis, GainsAloneActAtOnceAndKeepTheMemory) {
  All law(any_law(Tca(Tca::Params{.kp = 0})));
  std::array<Axis, 1> axes{pressing(5)};
  law.step(std::span(axes), ContactForce{});
  auto next = All::replacement(any_law(Tca(Tca::Params{.kp = 0, .peak_force = 2})));
  law.adopt(next);
  law.step(std::span(axes), ContactForce{});
  EXPECT_DOUBLE_EQ(axes[0].port.f_cmd, 2);
}

/// Notes that its world was changed.
struct Chain {
  int changed = 0;
  void change(const Environment&) EBAC_RT { ++changed; }
  void act(bool) EBAC_RT {}
};

TEST(ParameterUpdates, AnotherWorldMakesNoStepOfTheForce) {
  const AnyLaw tca = any_law(Tca(Tca::Params{.kp = 0}));
  All law(tca);
  ParameterUpdates<All> updates(tca);
  Chain chain;
  int device = 0;
  std::array<Axis, 1> axes{pressing(5)};
  law.step(std::span(axes), ContactForce{});
  updates.post(Environment(Free{}));
  updates.apply(1, law, chain, device);
  EXPECT_EQ(chain.changed, 1);
  axes[0] = pressing(0);
  law.step(std::span(axes), ContactForce{});
  EXPECT_DOUBLE_EQ(axes[0].port.f_cmd, 5);
  for (int i = 0; i < 25; ++i) law.step(std::span(axes), ContactForce{});
  EXPECT_NEAR(axes[0].port.f_cmd, 2.5, 1e-9);
  for (int i = 0; i < 25; ++i) law.step(std::span(axes), ContactForce{});
  EXPECT_NEAR(axes[0].port.f_cmd, 0, 1e-12);
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
