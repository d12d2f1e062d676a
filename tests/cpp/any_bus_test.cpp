// One end of a bus, and the wait on it.
#include "ebac/can/any_bus.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "ebac/can/wait.hpp"

namespace ebac::can::any_bus_test {
namespace {

using std::chrono::milliseconds;

struct TwoEnds {
  LoopbackHub hub{};
  AnyBus mine{hub.open()};
  LoopbackBus other{hub.open()};
};

TEST(AnyBus, GivesEveryFrameOnceAndInOrderWhetherWaitedForOrNot) {
  TwoEnds ends;
  for (std::uint8_t i = 0; i < 4; ++i) ASSERT_TRUE(ends.other.send(frame(0x180, {i})));
  Frame in;
  for (std::uint8_t i = 0; i < 4; ++i) {
    if (i % 2 == 0) {
      ASSERT_TRUE(ends.mine.wait(milliseconds(0)));
      ASSERT_TRUE(ends.mine.wait(milliseconds(0)));  // it is still there
    }
    ASSERT_TRUE(ends.mine.receive(in));
    EXPECT_EQ(in.data[0], i);
  }
  EXPECT_FALSE(ends.mine.receive(in));
  EXPECT_FALSE(ends.mine.wait(milliseconds(1)));
  EXPECT_EQ(ends.mine.counts().received, 4U);
}

TEST(AnyBus, SendsAndTellsHowTheBusStands) {
  TwoEnds ends;
  EXPECT_TRUE(ends.mine.send(frame(0x200, {1})));
  Frame in;
  EXPECT_TRUE(ends.other.receive(in));
  EXPECT_EQ(ends.mine.state(), BusState::kUp);
  ends.mine.close();
  EXPECT_EQ(ends.mine.state(), BusState::kClosed);
  EXPECT_FALSE(ends.mine.send(frame(0x200, {1})));
  EXPECT_EQ(AnyBus(SocketCan()).state(), BusState::kClosed);
}

TEST(WaitOn, LooksAgainWhileThereIsAFrameAndEndsWithItsBudget) {
  TwoEnds ends;
  WaitOn<AnyBus> wait(ends.mine, milliseconds(20));
  static_assert(Wait<WaitOn<AnyBus>>);
  wait.begin(0);
  ASSERT_TRUE(ends.other.send(frame(0x180, {})));
  EXPECT_TRUE(wait.more());
  Frame in;
  EXPECT_TRUE(ends.mine.receive(in));
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_FALSE(wait.more());
  EXPECT_LT(begun.time_since_epoch(), std::chrono::steady_clock::now().time_since_epoch());
  EXPECT_FALSE(wait.more());  // the budget stays spent
}

}  // namespace
}  // namespace ebac::can::any_bus_test
