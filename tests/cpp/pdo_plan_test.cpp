// The process data of a device, and what of a bus they take.
#include "ebac/canopen/pdo_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace ebac::can::pdo_plan_test {
namespace {

using std::string;

BusLoad load_of(std::vector<int> nodes, double period = 1e-3, double bit_rate = 1e6) {
  return {.frames = pdo_plan(nodes), .bit_rate = bit_rate, .period = period};
}

string refusal(const BusLoad& load) {
  try {
    static_cast<void>(check_load(load));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(WorstBits, OfAFrame) {
  EXPECT_EQ(worst_bits(0), 55);
  EXPECT_EQ(worst_bits(4), 95);
  EXPECT_EQ(worst_bits(8), 135);
}

TEST(WorstBits, IsWhatTheWorstPatternTakes) {
  // Five equal bits, then four of the other kind, again and again: each stuff bit helps to the next.
  for (int size = 0; size <= 8; ++size) {
    int stuffed = 0;
    int run = 0;
    bool last = true;
    bool bit = false;
    const int stuffable = 34 + 8 * size;
    for (int sent = 0; sent < stuffable; ++sent) {
      if (run == 5) {  // the stuff bit starts a run of its own
        ++stuffed;
        last = !last;
        run = 1;
        bit = last;
      }
      run = sent > 0 && bit == last ? run + 1 : 1;
      last = bit;
    }
    if (run == 5) ++stuffed;
    EXPECT_LE(8 * size + 47 + stuffed, worst_bits(size)) << size;
    EXPECT_GE(8 * size + 47 + stuffed, worst_bits(size) - 1) << size;
  }
}

TEST(PdoPlan, NamesTheFramesOfATick) {
  const auto plan = pdo_plan(std::vector{1, 5});
  ASSERT_EQ(plan.size(), 5);
  EXPECT_EQ(plan[0].id, 0x080);
  EXPECT_EQ(plan[0].size, 0);
  EXPECT_EQ(plan[1].id, 0x201);
  EXPECT_EQ(plan[1].size, 4);
  EXPECT_EQ(plan[2].id, 0x181);
  EXPECT_EQ(plan[2].size, 8);
  EXPECT_EQ(plan[3].id, 0x205);
  EXPECT_EQ(plan[4].id, 0x185);
}

TEST(PdoPlan, RefusesNodesThatCannotBe) {
  EXPECT_THROW(static_cast<void>(pdo_plan(std::vector{0})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(pdo_plan(std::vector{128})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(pdo_plan(std::vector{3, 4, 3})), std::invalid_argument);
}

TEST(BusLoad, OfTwoDrivesAtOneKilohertz) {
  const BusLoad load = load_of({1, 2});
  EXPECT_EQ(load.bits(), 515);
  EXPECT_NEAR(load.seconds(), 515e-6, 1e-12);
  EXPECT_NEAR(load.share(), 0.515, 1e-12);
  EXPECT_EQ(check_load(load), "");
  double sum = 0;
  for (const PlannedFrame& frame : load.frames) sum += load.share(frame);
  EXPECT_NEAR(sum, load.share(), 1e-12);
}

TEST(BusLoad, HeartbeatsComeAfterATimeOfTheirOwn) {
  BusLoad load = load_of({1, 2});
  for (PlannedFrame& beat : heartbeat_plan(std::vector{1, 2}, 0.1, 100, 0.01)) {
    load.frames.push_back(std::move(beat));
  }
  ASSERT_EQ(load.frames.size(), 8);
  EXPECT_EQ(load.frames[5].id, 0x701);
  EXPECT_EQ(load.frames[6].id, 0x702);
  EXPECT_EQ(load.frames[7].id, 0x764);
  EXPECT_EQ(load.bits(), 515 + 3 * 65);  // of a tick in which all of them come
  EXPECT_NEAR(load.share(), 0.515 + 2 * 65e-5 + 65e-4, 1e-12);
  double sum = 0;
  for (const PlannedFrame& frame : load.frames) sum += load.share(frame);
  EXPECT_NEAR(sum, load.share(), 1e-12);
  // At its highest rate the process data leave what the heartbeats take.
  BusLoad fastest = load;
  fastest.period = 1 / load.highest_rate();
  EXPECT_NEAR(fastest.share(), kRefusedLoad, 1e-12);
}

TEST(BusLoad, AFrameMoreOftenThanThePeriodComesSeveralTimesInOne) {
  const BusLoad load{.frames = heartbeat_plan(std::vector{1}, 1e-3, 100, 0), .period = 4e-3};
  EXPECT_EQ(load.bits(), 5 * 65);
  EXPECT_NEAR(load.share(), 0.065, 1e-12);
}

TEST(BusLoad, RefusesATimeThatNoFrameHas) {
  for (const double every : {-1.0, 1e-9, std::nan(""), HUGE_VAL}) {
    const PlannedFrame frame{.what = "odd", .id = 1, .every = every};
    EXPECT_NE(refusal({.frames = {frame}}).find("BusLoad.every"), string::npos) << every;
    EXPECT_GE((BusLoad{.frames = {frame}}.bits()), 0);
  }
}

TEST(HeartbeatPlan, HasThoseThatAreSent) {
  EXPECT_TRUE(heartbeat_plan(std::vector{1, 2}, 0, 0, 0).empty());
  EXPECT_EQ(heartbeat_plan(std::vector{1, 2}, 0.1, 0, 0).size(), 2);
  EXPECT_THROW(static_cast<void>(heartbeat_plan(std::vector{1}, 0.1, 0, 0.1)),
               std::invalid_argument);
}

TEST(BusLoad, AForceSensorOnTheSameBusIsWarnedOf) {
  BusLoad load = load_of({1, 2});
  load.frames.push_back({.what = "force sensor", .id = 0x1F, .size = 8, .count = 2});
  EXPECT_NEAR(load.share(), 0.785, 1e-12);
  const string warning = check_load(load);
  EXPECT_NE(warning.find("785 us of each 1000 us, 78.5 % of a bus at 1000 kbit/s"), string::npos)
      << warning;
  EXPECT_NE(warning.find("a rate up to 1146 Hz"), string::npos) << warning;
}

TEST(BusLoad, TwoKilohertzDoNotFit) {
  const string why = refusal(load_of({1, 2}, 0.5e-3));
  EXPECT_NE(why.find("515 us of each 500 us, 103 % of a bus at 1000 kbit/s"), string::npos) << why;
  EXPECT_NE(why.find("a rate up to 1747 Hz"), string::npos) << why;
  EXPECT_EQ(refusal(load_of({1, 2}, 1 / 1747.0)), "accepted");
  EXPECT_NE(refusal(load_of({1, 2}, 1 / 1748.0)), "accepted");
}

TEST(BusLoad, ASlowerBusIsToldOfAFasterOne) {
  const string why = refusal(load_of({1, 2}, 1e-3, 500e3));
  EXPECT_NE(why.find("a bus of up to 1000 kbit/s"), string::npos) << why;
}

TEST(BusLoad, AsManyFramesAsItTakesAreTooMany) {
  const PlannedFrame many{.what = "many", .id = 0x200, .size = 8, .count = 1'000'000};
  EXPECT_NE(refusal({.frames = {20, many}}), "accepted");
}

TEST(BusLoad, RefusesWhatNoBusHas) {
  EXPECT_NE(refusal(load_of({1}, 1e-3, 2e6)).find("BusLoad.bit_rate = 2e+06 bit/s: must lie in"),
            string::npos);
  EXPECT_NE(refusal(load_of({1}, 0)).find("BusLoad.period = 0 s: must lie in"), string::npos);
  EXPECT_NE(refusal({.frames = {{.what = "long", .id = 1, .size = 9}}}), "accepted");
}

}  // namespace
}  // namespace ebac::can::pdo_plan_test
