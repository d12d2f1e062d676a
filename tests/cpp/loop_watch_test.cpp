// How long a drive waits for its loop, against how often the loop sends.
#include "ebac/canopen/loop_watch.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace ebac::can::loop_watch_test {
namespace {

std::string refusal(const LoopWatch& watch, double dt) {
  try {
    check_watch(watch, dt);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SentEvery, IsInWholeTicks) {
  EXPECT_DOUBLE_EQ(sent_every(0, 1e-3), 1e-3);
  EXPECT_DOUBLE_EQ(sent_every(1e-3, 0.7e-3), 1.4e-3);
  for (int ticks = 1; ticks < 2000; ++ticks) {
    for (const double dt : {1e-4, 1e-3, 3e-3})
      EXPECT_DOUBLE_EQ(sent_every(ticks * dt, dt), ticks * dt);
  }
}

TEST(BeatPeriod, IsATenthOfTheSilenceWithinWhatALoopCanSend) {
  EXPECT_DOUBLE_EQ(beat_period(0.3), 0.03);
  EXPECT_DOUBLE_EQ(beat_period(1e-3), 1e-3);
  EXPECT_DOUBLE_EQ(beat_period(1e4), 60);
}

TEST(CheckWatch, CountsTheMillisecondsOfTheDrive) {
  const LoopWatch watch{.name = "torque_silence", .seconds = 0.0014, .ms = 1, .what = "torque"};
  EXPECT_EQ(refusal(watch, 0.9e-3), "accepted");
  const std::string why = refusal(watch, 1.2e-3);
  EXPECT_NE(
      why.find("torque_silence = 0.0014 s: a drive lets go without a torque for 1 ms, and the "
               "next one comes after a tick of 0.0012 s; must be longer"),
      std::string::npos)
      << why;
}

TEST(CheckWatch, AWatchOfNothingIsNone) {
  EXPECT_EQ(refusal({.name = "none", .what = "torque"}, 1), "accepted");
}

TEST(CheckWatch, CountsTheTicksUntilTheNextSign) {
  LoopWatch watch{
      .name = "loop_silence", .seconds = 1e-3, .ms = 1, .what = "heartbeat", .period = 1e-3};
  EXPECT_NE(refusal(watch, 0.7e-3).find("after 2 ticks, 0.0014 s"), std::string::npos);
  watch.ms = 2;
  EXPECT_EQ(refusal(watch, 0.7e-3), "accepted");
}

}  // namespace
}  // namespace ebac::can::loop_watch_test
