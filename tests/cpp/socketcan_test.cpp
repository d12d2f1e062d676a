// SocketCAN. The first half runs anywhere; the second needs a virtual interface it may do anything with, named by
// EBAC_CAN (`.ci/socketcan/run` gives one), and root, as it takes the interface down and away.
#include "ebac/can/socketcan.hpp"

#include <gtest/gtest.h>
#include <linux/can/error.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <random>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "ebac/can/raw_socket.hpp"
#include "ebac/canopen/cob_id.hpp"

namespace ebac::can::socketcan_test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// Why an interface cannot be opened; empty when it can.
std::string complaint(const std::string& interface) {
  try {
    const SocketCan open(interface);
    return {};
  } catch (const std::system_error& error) {
    return error.what();
  }
}

bool kernel_has_can() {
  return complaint("no-such-if0").find("no CAN sockets") == std::string::npos;
}

TEST(Wire, FramesComeBackAsTheyWere) {
  std::mt19937 random(1);  // NOLINT(bugprone-random-generator-seed): the same frames every time
  for (int i = 0; i < 10'000; ++i) {
    Frame out{.size = static_cast<std::uint8_t>(random() % 9),
              .extended = random() % 2 == 0,
              .remote = random() % 4 == 0};
    out.id = static_cast<std::uint32_t>(random()) & (out.extended ? kExtendedIds : kStandardIds);
    for (std::size_t b = 0; b < out.size && !out.remote; ++b) {
      out.data[b] = static_cast<std::uint8_t>(random());
    }
    EXPECT_EQ(from_wire(to_wire(out)), out);
  }
  const Frame error{.id = CAN_ERR_BUSOFF | CAN_ERR_CRTL, .size = 8, .error = true};
  EXPECT_EQ(from_wire(to_wire(error)), error);
}

TEST(Wire, ALengthBeyondEightIsCut) {
  can_frame wire{};
  wire.len = 255;
  EXPECT_EQ(from_wire(wire).size, 8);
  EXPECT_EQ(to_wire(Frame{.size = 255}).len, 8);
}

TEST(Wire, AFilterHasNoFlagsButItsOwn) {
  const auto wire = to_wire(std::vector<CanFilter>{{.id = CAN_INV_FILTER | 0x123}});
  EXPECT_EQ(wire[0].can_id, 0x123U);
  EXPECT_EQ(wire[0].can_mask, CAN_EFF_FLAG | kStandardIds);
}

Frame controller_error(std::uint32_t what, std::uint8_t controller = 0) {
  Frame error{.id = what, .size = 8, .error = true};
  error.data[1] = controller;
  return error;
}

TEST(Wire, ErrorFramesTellTheState) {
  for (const BusState before : {BusState::kUp, BusState::kPassive, BusState::kBusOff}) {
    const auto after = [&](const Frame& error) { return after_error(error, before); };
    EXPECT_EQ(after(controller_error(CAN_ERR_BUSOFF)), BusState::kBusOff);
    EXPECT_EQ(after(controller_error(CAN_ERR_BUSOFF | CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE)),
              BusState::kBusOff);
    EXPECT_EQ(after(controller_error(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_WARNING)), BusState::kWarning);
    EXPECT_EQ(after(controller_error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING)), BusState::kWarning);
    EXPECT_EQ(
        after(controller_error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE | CAN_ERR_CRTL_TX_WARNING)),
        BusState::kPassive);
    EXPECT_EQ(after(controller_error(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE)), BusState::kUp);
    EXPECT_EQ(after(controller_error(CAN_ERR_RESTARTED)), BusState::kUp);
    EXPECT_EQ(after(controller_error(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW)), before);
    EXPECT_EQ(after(controller_error(CAN_ERR_ACK)), before);
  }
}

TEST(SocketCan, AnEndOfNothingIsClosed) {
  SocketCan none;
  Frame in;
  EXPECT_EQ(none.state(), BusState::kClosed);
  EXPECT_FALSE(none.send(frame(1, {})));
  EXPECT_FALSE(none.receive(in));
  EXPECT_FALSE(none.receive(in, 10s));
  EXPECT_EQ(none.counts().refused, 0);
  none.close();
}

TEST(SocketCan, NamesNoInterfaceCanHaveAreRefused) {
  for (const std::string& name : {std::string(), std::string("a-name-too-long-0")}) {
    EXPECT_NE(complaint(name).find("1 to 15 letters"), std::string::npos) << complaint(name);
  }
}

TEST(SocketCan, MoreFiltersThanTheKernelTakesAreRefusedAsThat) {
  try {
    const SocketCan open("can0", {.filters = std::vector<CanFilter>(513)});
    FAIL() << "opened";
  } catch (const std::system_error& error) {
    EXPECT_NE(std::string(error.what()).find("513 filters"), std::string::npos) << error.what();
  }
}

TEST(SocketCan, AKernelWithoutCanIsTold) {
  if (kernel_has_can()) GTEST_SKIP() << "this kernel has CAN";
  try {
    const SocketCan open("can0");
    FAIL() << "opened";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code().value(), EAFNOSUPPORT);
    EXPECT_NE(std::string(error.what()).find("CAN interface 'can0'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("modprobe can_raw"), std::string::npos);
  }
}

/// Tests on an interface they may do anything with.
class OnInterface : public testing::Test {
 protected:
  void SetUp() override {
    const char* name = std::getenv("EBAC_CAN");
    if (name == nullptr) {
      GTEST_SKIP() << "EBAC_CAN names no virtual CAN interface to test on; .ci/socketcan/run does";
    }
    name_ = name;
    ip("link set " + name_ + " up");
  }

  const std::string& name() const { return name_; }
  void ip(const std::string& what) const {
    ASSERT_EQ(std::system(("ip " + what).c_str()), 0);  // NOLINT(bugprone-command-processor)
  }
  void down() const { ip("link set " + name_ + " down"); }
  void up() const { ip("link set " + name_ + " up"); }
  void remove() const { ip("link del " + name_); }
  void add() const { ip("link add dev " + name_ + " type vcan"); }

 private:
  std::string name_;
};

std::vector<Frame> all_of(SocketCan& end) {
  std::vector<Frame> got;
  for (Frame in; end.receive(in, 50ms);) got.push_back(in);
  return got;
}

TEST_F(OnInterface, FramesGoToTheOthers) {
  SocketCan a(name());
  SocketCan b(name());
  const std::vector<Frame> sent = {
      frame(kSync, {}),
      frame(0x7FF, {1, 2, 3, 4, 5, 6, 7, 8}),
      {.id = 0x1FFFFFFF, .size = 2, .extended = true, .data = {9, 8}},
      {.id = 0x701, .size = 1, .remote = true},
  };
  for (const Frame& out : sent) EXPECT_TRUE(a.send(out));
  EXPECT_EQ(all_of(b), sent);
  EXPECT_TRUE(all_of(a).empty());
  EXPECT_EQ(a.counts().sent, sent.size());
  EXPECT_EQ(b.counts().received, sent.size());
  EXPECT_EQ(a.state(), BusState::kUp);
}

TEST_F(OnInterface, TheKernelStamps) {
  SocketCan a(name());
  SocketCan b(name());
  const auto now = [] {
    return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
  };
  const std::int64_t before = now();
  a.send(frame(1, {}));
  Frame in;
  ASSERT_TRUE(b.receive(in, 1s));
  EXPECT_LE(before, in.stamp);
  EXPECT_LE(in.stamp, now());
}

TEST_F(OnInterface, OwnFramesComeBackWhereAskedFor) {
  SocketCan a(name(), {.own = true});
  SocketCan b(name());
  a.send(frame(1, {}));
  b.send(frame(2, {}));
  const auto got = all_of(a);
  ASSERT_EQ(got.size(), 2);
  EXPECT_TRUE(got[0].own);
  EXPECT_FALSE(got[1].own);
}

TEST_F(OnInterface, FiltersLetThroughWhatTheyName) {
  SocketCan a(name());
  SocketCan one(name(), {.filters = {{.id = 0x181}}});
  SocketCan two(name(), {.filters = {{.id = 0x580, .mask = 0x780}, {.id = kSync}}});
  SocketCan wide(name(), {.filters = {{.id = 0x181, .mask = kExtendedIds, .extended = true}}});
  a.send(frame(0x181, {1}));
  a.send(frame(0x182, {2}));
  a.send(frame(0x581, {3}));
  a.send(frame(kSync, {4}));
  a.send({.id = 0x181, .size = 1, .extended = true, .data = {5}});
  const auto first_bytes = [](SocketCan& end) {
    std::vector<int> bytes;
    for (const Frame& in : all_of(end)) bytes.push_back(in.data[0]);
    return bytes;
  };
  EXPECT_EQ(first_bytes(one), std::vector{1});
  EXPECT_EQ(first_bytes(two), (std::vector{3, 4}));
  EXPECT_EQ(first_bytes(wide), std::vector{5});
}

TEST_F(OnInterface, ImpossibleFramesAreRefusedAndCounted) {
  SocketCan a(name());
  EXPECT_FALSE(a.send({.id = 0x800}));
  EXPECT_FALSE(a.send({.id = 1, .size = 9}));
  EXPECT_EQ(a.counts().refused, 2);
  EXPECT_EQ(a.state(), BusState::kUp);
}

TEST_F(OnInterface, ErrorFramesBecomeTheState) {
  SocketCan a(name());
  SocketCan quiet(name());
  SocketCan told_all(name(), {.errors = true});
  const auto after = [&](const Frame& error) {
    EXPECT_TRUE(a.send(error));
    EXPECT_TRUE(all_of(quiet).empty());
    return quiet.state();
  };
  EXPECT_EQ(after(controller_error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING)), BusState::kWarning);
  EXPECT_EQ(after(controller_error(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE)), BusState::kPassive);
  EXPECT_EQ(after(controller_error(CAN_ERR_BUSOFF)), BusState::kBusOff);
  EXPECT_EQ(after(controller_error(CAN_ERR_RESTARTED)), BusState::kUp);
  EXPECT_EQ(all_of(told_all).size(), 4);
  EXPECT_EQ(told_all.state(), BusState::kUp);
}

TEST_F(OnInterface, AFullReceiveQueueIsCounted) {
  SocketCan a(name());
  SocketCan b(name());
  constexpr std::uint64_t kMany = 20'000;
  for (std::uint64_t i = 0; i < kMany; ++i) ASSERT_TRUE(a.send(frame(1, {})));
  const std::uint64_t kept = all_of(b).size();
  EXPECT_LT(kept, kMany);
  a.send(frame(2, {}));  // the kernel reports the loss with the next frame it takes
  EXPECT_EQ(all_of(b).size(), 1);
  EXPECT_EQ(b.counts().lost, kMany - kept);
}

TEST_F(OnInterface, DownAndUpAgain) {
  SocketCan a(name());
  SocketCan b(name());
  Frame in;
  down();
  EXPECT_FALSE(b.receive(in));
  EXPECT_EQ(b.state(), BusState::kDown);
  EXPECT_FALSE(a.send(frame(1, {})));
  EXPECT_EQ(a.state(), BusState::kDown);
  EXPECT_FALSE(a.send(frame(1, {})));
  EXPECT_EQ(a.counts().refused, 2);
  EXPECT_NE(complaint(name()).find("ip link set " + name() + " up"), std::string::npos);
  up();
  EXPECT_TRUE(a.send(frame(2, {})));
  ASSERT_TRUE(b.receive(in, 1s));
  EXPECT_EQ(in, frame(2, {}));
  EXPECT_EQ(a.state(), BusState::kUp);
  EXPECT_EQ(b.state(), BusState::kUp);
}

TEST_F(OnInterface, AwayAndBackAgain) {
  SocketCan a(name());
  SocketCan b(name(), {.filters = {{.id = 0x181}}});
  Frame in;
  remove();
  EXPECT_FALSE(a.send(frame(1, {})));
  EXPECT_FALSE(b.receive(in));
  EXPECT_EQ(a.state(), BusState::kDown);
  EXPECT_EQ(b.state(), BusState::kDown);
  EXPECT_NE(complaint(name()).find("there is no such interface"), std::string::npos);
  add();
  EXPECT_FALSE(a.send(frame(1, {})));
  EXPECT_FALSE(b.receive(in));
  EXPECT_EQ(b.state(), BusState::kDown);
  up();
  EXPECT_FALSE(b.receive(in));  // binds anew
  EXPECT_EQ(b.state(), BusState::kUp);
  EXPECT_TRUE(a.send(frame(0x182, {})));
  EXPECT_TRUE(a.send(frame(0x181, {7})));
  EXPECT_EQ(all_of(b), std::vector{frame(0x181, {7})});
}

TEST_F(OnInterface, WhatNobodyNoticedIsNoTrouble) {
  SocketCan a(name());
  SocketCan b(name());
  Frame in;
  for (const bool away : {false, true}) {
    if (away) {
      remove();
      add();
    } else {
      down();
    }
    up();
    EXPECT_FALSE(b.receive(in));
    EXPECT_EQ(b.state(), BusState::kUp);
    EXPECT_TRUE(a.send(frame(1, {1})));
    EXPECT_EQ(a.state(), BusState::kUp);
    EXPECT_EQ(all_of(b), std::vector{frame(1, {1})});
  }
}

TEST_F(OnInterface, WaitingSleepsThroughAnInterfaceThatGoesAway) {
  SocketCan a(name());
  SocketCan b(name());
  std::atomic<bool> waiting{false};
  std::thread reader([&] {
    Frame in;
    waiting = true;
    EXPECT_TRUE(b.receive(in, 10s));
    EXPECT_EQ(in, frame(3, {}));
  });
  while (!waiting) std::this_thread::yield();
  remove();
  add();
  up();
  std::this_thread::sleep_for(300ms);  // longer than it sleeps at a time
  EXPECT_TRUE(a.send(frame(3, {})));
  reader.join();
}

TEST_F(OnInterface, WaitingEndsWithItsTimeAndWithClose) {
  SocketCan a(name());
  Frame in;
  auto start = Clock::now();
  EXPECT_FALSE(a.receive(in, 30ms));
  EXPECT_GE(Clock::now() - start, 30ms);
  std::thread reader([&] {
    Frame none;
    EXPECT_FALSE(a.receive(none, std::chrono::nanoseconds::max()));
  });
  std::this_thread::sleep_for(20ms);
  a.close();
  reader.join();
  EXPECT_EQ(a.state(), BusState::kClosed);
  EXPECT_FALSE(a.send(frame(1, {})));
}

TEST_F(OnInterface, AnEndMovesWithWhatItHolds) {
  SocketCan a(name());
  SocketCan b(name());
  a.send(frame(1, {5}));
  SocketCan moved = std::move(b);
  EXPECT_EQ(all_of(moved), std::vector{frame(1, {5})});
}

TEST_F(OnInterface, OtherInterfacesAreNoCan) {
  EXPECT_NE(complaint("lo").find("no CAN interface"), std::string::npos) << complaint("lo");
}

}  // namespace
}  // namespace ebac::can::socketcan_test
