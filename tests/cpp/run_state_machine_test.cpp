// Start, pauses and end of a run.
#include "ebac/loop/run_state_machine.hpp"

#include <gtest/gtest.h>

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
