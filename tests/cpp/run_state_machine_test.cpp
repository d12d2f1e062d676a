// Start, pauses and end of a run.
#include "ebac/loop/run_state_machine.hpp"

#include <gtest/gtest.h>

#include <random>

namespace ebac::run_state_machine_test {
namespace {

constexpr double kTick = 1e-3;  // s

RunStateMachine at_work(const RunPlan& plan) {
  RunStateMachine run(plan);
  EXPECT_TRUE(run.start());
  for (int i = 0; i < 100; ++i) run.advance(true, false, kTick);
  EXPECT_EQ(run.gain(), 1.0);
  return run;
}

TEST(Start, GivesNoForceBeforeTheDrivesAreReady) {
  for (const double soft_start : {0.0, 0.05}) {
    RunStateMachine run({.soft_start = soft_start, .arm = true});
    EXPECT_TRUE(run.start());
    EXPECT_EQ(run.gain(), 0.0) << "armed, but no tick has been";
    for (int i = 0; i < 200; ++i) {
      run.advance(/*ready=*/false, false, kTick);
      ASSERT_EQ(run.state(), LoopState::kArm);
      ASSERT_EQ(run.gain(), 0.0);
      ASSERT_FALSE(run.first());
    }
    run.advance(/*ready=*/true, false, kTick);
    EXPECT_EQ(run.state(), LoopState::kRun);
    EXPECT_TRUE(run.first());
  }
}

TEST(Start, LetsTheForceInOverTheWholeSoftStart) {
  for (const bool arm : {false, true}) {
    RunStateMachine run({.soft_start = 0.05, .arm = arm});
    EXPECT_TRUE(run.start());
    for (int i = 1; i <= 50; ++i) {
      run.advance(true, false, kTick);
      EXPECT_NEAR(run.gain(), i / 50.0, 1e-12);
    }
  }
}

TEST(Start, TellsWhatComesInAndAfterAPauseWhatGoes) {
  std::mt19937 random(1);
  for (const bool arm : {false, true}) {
    RunStateMachine run({.soft_start = 0.05, .arm = arm});
    EXPECT_TRUE(run.start());
    double sum = 0;
    for (int i = 0; i < 5000; ++i) {
      run.advance(/*ready=*/i > 3, false, kTick);
      if (random() % 60 == 0) run.resume();
      sum += run.came();
      ASSERT_NEAR(sum, run.gain(), 1e-9);
    }
    run.advance(true, /*asked=*/true, kTick);
    EXPECT_EQ(run.came(), 0.0) << "a stop is no soft start";
  }
}

TEST(Start, IsRefusedWhileItRunsAndWhileItStops) {
  RunStateMachine run = at_work({.ramp_down = 0.01});
  EXPECT_FALSE(run.start());
  EXPECT_EQ(run.state(), LoopState::kRun);
  run.advance(true, true, kTick);
  EXPECT_FALSE(run.start());
  EXPECT_EQ(run.state(), LoopState::kStop);
}

TEST(Fault, StopsAtOnceWithoutARamp) {
  RunStateMachine run = at_work({.ramp_down = 0.2});
  run.fail(Fault::kDevice);
  EXPECT_EQ(run.state(), LoopState::kStop);
  EXPECT_EQ(run.gain(), 0.0);
  EXPECT_TRUE(run.stopping());
  run.advance(true, false, kTick);
  EXPECT_EQ(run.gain(), 0.0);
}

TEST(Fault, LatchesForGood) {
  RunStateMachine run = at_work({.stop_ticks = 3});
  run.fail(Fault::kDevice);
  run.fail(Fault::kLawNotFinite);
  EXPECT_EQ(run.fault(), Fault::kDevice);
  for (int k = 0; k < 2; ++k) {
    EXPECT_FALSE(run.finish());
    run.advance(true, false, kTick);
  }
  EXPECT_TRUE(run.finish());
  EXPECT_EQ(run.state(), LoopState::kFault);
  EXPECT_FALSE(run.start()) << "nothing starts again by itself";
  EXPECT_EQ(run.state(), LoopState::kFault);
}

TEST(Pause, LetsTheForceInAnew) {
  RunStateMachine run = at_work({.soft_start = 0.05, .arm = true});
  run.resume();
  EXPECT_EQ(run.gain(), 0.0);
  EXPECT_EQ(run.state(), LoopState::kRun);
  run.advance(true, false, kTick);
  EXPECT_NEAR(run.gain(), 0.02, 1e-12);
  for (int i = 0; i < 50; ++i) run.advance(true, false, kTick);
  EXPECT_EQ(run.gain(), 1.0);
}

TEST(Stop, RampsDownToNoForceAndEnds) {
  RunStateMachine run = at_work({.ramp_down = 0.2, .stop_ticks = 10});
  for (int i = 1; i < 200; ++i) {
    run.advance(true, true, kTick);
    EXPECT_NEAR(run.gain(), 1 - i / 200.0, 1e-12);
    ASSERT_FALSE(run.finish());
  }
  int n = 0;
  for (bool over = false; !over && n < 100; ++n) {
    run.advance(true, true, kTick);
    over = run.finish();
  }
  EXPECT_EQ(run.gain(), 0.0);
  EXPECT_EQ(run.state(), LoopState::kIdle);
  EXPECT_NEAR(n, 10, 1) << "the ticks of a stop begin where the force ends";
}

TEST(Stop, WhileArmingNeverRuns) {
  RunStateMachine run({.arm = true});
  EXPECT_TRUE(run.start());
  run.advance(false, true, kTick);
  EXPECT_EQ(run.state(), LoopState::kStop);
  run.advance(true, false, kTick);
  EXPECT_EQ(run.state(), LoopState::kStop);
  EXPECT_EQ(run.gain(), 0.0);
}

TEST(Stop, AtOnceLeavesOutTheRamp) {
  RunStateMachine run = at_work({.soft_start = 0.05, .ramp_down = 0.2, .arm = true});
  run.advance(true, true, kTick);
  EXPECT_NEAR(run.gain(), 0.995, 1e-12);
  EXPECT_FALSE(run.stopping());
  run.advance(true, true, kTick, /*at_once=*/true);
  EXPECT_EQ(run.gain(), 0.0);
  EXPECT_TRUE(run.stopping());
}

TEST(Stop, WaitsForADeviceThatIsNotAtRestButNotForEver) {
  const auto ticks = [](int at_rest_after) {
    RunStateMachine run = at_work({.soft_start = 0.05, .stop_ticks = 10, .rest_ticks = 500});
    int n = 0;
    for (bool over = false; !over && n < 2000; ++n) {
      run.advance(true, true, kTick);
      over = run.finish(n >= at_rest_after);
    }
    return n;
  };
  EXPECT_EQ(ticks(0), 10);
  EXPECT_EQ(ticks(9), 10);
  EXPECT_EQ(ticks(200), 201);
  EXPECT_EQ(ticks(100'000), 510);
}

}  // namespace
}  // namespace ebac::run_state_machine_test
