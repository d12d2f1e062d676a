#include "ebac/can/node_server.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <thread>

#include "ebac/can/loopback_bus.hpp"
#include "ebac/canopen/torque.hpp"
#include "ebac/sim/simulated_device.hpp"
#include "ebac/simulated_drives/joystick.hpp"
#include "timed_run.hpp"

namespace ebac::can::node_server_test {
namespace {

using std::chrono::milliseconds;
using OnLoopback = NodeServer<LoopbackBus, Joystick<SimulatedDevice>>;

/// Two axes in a hand that holds them where they are.
Joystick<SimulatedDevice> held_joystick() {
  Setup setup;
  setup.device.kinematics = Linear{.axes = 2};
  setup.device.drive.permille = true;
  setup.hand.path = {Step{.target = 0}, Step{.target = 0}, Step{.target = 0}};
  setup.timing.delay = 0;
  return {SimulatedDevice(setup), setup.device};
}

/// The next frame with that identifier, however busy the machine.
bool hears(LoopbackBus& end, std::uint32_t id, Frame& in) {
  while (end.receive(in, std::chrono::seconds{20})) {
    if (in.id == id) return true;
  }
  return false;
}

/// Writes a number by SDO, expedited: whether the drive took it.
bool download(LoopbackBus& end, NodeId node, const ObjectWrite& write) {
  const std::size_t slot = kDriveTable.slot(write.index, write.sub);
  const auto size = width(kDriveTable.entry[slot].type);
  Frame out{.id = sdo_request(node), .size = 8};
  out.data[0] = static_cast<std::uint8_t>(0x23 | (4 - size) << 2);
  put(out.data, 1, write.index);
  out.data[3] = write.sub;
  put(out.data, 4, static_cast<std::uint32_t>(write.value));
  end.send(out);
  Frame answer;
  return hears(end, sdo_answer(node), answer) && answer.data[0] == 0x60;
}

TEST(NodeServer, BootsAndSendsHeartbeatsByItself) {
  LoopbackHub hub(LoopbackHub::Stamps::kWallClock);
  LoopbackBus end = hub.open();
  OnLoopback server(hub.open(), held_joystick());
  Frame none;
  EXPECT_FALSE(end.receive(none, milliseconds{5}));
  server.start();
  EXPECT_TRUE(hears(end, heartbeat(1), none) && none.data[0] == 0);
  EXPECT_TRUE(hears(end, heartbeat(2), none) && none.data[0] == 0);
  ASSERT_TRUE(download(end, 2, {0x1017, 0, 5}));
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(hears(end, heartbeat(2), none));
    EXPECT_EQ(none.data[0], 0x7F);
  }
  EXPECT_EQ(server.state(), BusState::kUp);
  server.stop();
  EXPECT_GE(server.counts().sent, 7U);
}

TEST(NodeServer, LeavesTheBusOnceAndForAll) {
  LoopbackHub hub;
  {
    OnLoopback server(hub.open(), held_joystick());
    EXPECT_EQ(hub.ends(), 1U);
    server.start();
    EXPECT_THROW(server.start(), std::logic_error);
    server.stop();
    server.stop();
    EXPECT_EQ(hub.ends(), 0U);
    EXPECT_EQ(server.state(), BusState::kClosed);
    EXPECT_THROW(server.start(), std::logic_error);
  }
  {
    OnLoopback never_started(hub.open(), held_joystick());
    never_started.stop();
    EXPECT_THROW(never_started.start(), std::logic_error);
  }
  {
    OnLoopback forgotten(hub.open(), held_joystick());
    forgotten.start();
  }
  EXPECT_EQ(hub.ends(), 0U);
}

/// Notes whether it is asked for a frame after its server was stopped.
struct Guarded {
  std::shared_ptr<std::atomic<bool>> stopped = std::make_shared<std::atomic<bool>>(false);
  std::shared_ptr<std::atomic<int>> late = std::make_shared<std::atomic<int>>(0);

  static void receive(const Frame&) noexcept {}
  bool take(Frame&) const noexcept {
    if (*stopped) ++*late;
    return false;
  }
  static void elapse(double) noexcept {}
};

TEST(NodeServer, IsOverOnceStoppedThoughAnotherThreadJustStartedIt) {
  for (int i = 0; i < 300; ++i) {
    LoopbackHub hub;
    const Guarded node;
    std::atomic<bool> ready = false;
    NodeServer<LoopbackBus, Guarded> server(hub.open(), node);
    std::thread other([&] {
      ready = true;
      try {
        server.start();
      } catch (const std::logic_error&) {  // it was stopped before
      }
    });
    while (!ready) {
    }
    std::this_thread::sleep_for(std::chrono::microseconds{2 * (i % 50)});
    server.stop();
    *node.stopped = true;
    other.join();
    std::this_thread::yield();
    ASSERT_EQ(*node.late, 0) << i;
  }
}

TEST(NodeServer, TheLoopRunsAHandGivesWayAndAThirdHearsItAll) {
  constexpr int kTicks = 200;
  LoopbackHub hub(LoopbackHub::Stamps::kWallClock);
  LoopbackBus end = hub.open();
  LoopbackBus third = hub.open({.frames = 1U << 16});
  OnLoopback server(hub.open(), held_joystick());
  server.start();
  for (const NodeId node : {NodeId{1}, NodeId{2}}) {
    for (const ObjectWrite& write : torque_settings(node, 4000)) {
      ASSERT_TRUE(download(end, node, write)) << std::hex << write.index;
    }
  }
  const TimedRun run = run_in_real_time(end, kTicks, /*current=*/0.2);
  EXPECT_TRUE(run.ran);
  EXPECT_EQ(run.fault, Fault::kNone);
  EXPECT_NEAR(run.current_echoed, 0.2, 1e-3);
  EXPECT_GT(std::abs(run.last - run.first), 20);  // counts
  EXPECT_TRUE(run.rested);
  std::map<std::uint32_t, int> heard;
  for (Frame frame; third.receive(frame);) ++heard[frame.id];
  EXPECT_GE(heard[kSync], kTicks);
  for (const NodeId node : {NodeId{1}, NodeId{2}}) {
    EXPECT_EQ(heard[rpdo(1, node)], heard[kSync]);
    EXPECT_GE(heard[tpdo(1, node)], kTicks);
  }
  EXPECT_EQ(third.counts().lost, 0U);
}

/// Notes when, by its own time, each frame came; and is held up at the first one.
class Diary {
 public:
  struct Entry {
    std::int64_t stamp = 0;  // ns
    double at = 0;           // s
  };
  void receive(const Frame& frame) noexcept {
    if (count_ == 0) std::this_thread::sleep_for(milliseconds{400});
    if (count_ < entries_.size()) entries_[count_++] = {frame.stamp, now_};
  }
  static bool take(Frame&) noexcept { return false; }
  void elapse(double seconds) noexcept { now_ += seconds; }
  std::span<const Entry> entries() const noexcept { return std::span(entries_).first(count_); }

 private:
  double now_ = 0;
  std::size_t count_ = 0;
  std::array<Entry, 16> entries_{};
};

TEST(NodeServer, AFrameThatWaitedCountsFromWhenItCame) {
  LoopbackHub hub(LoopbackHub::Stamps::kWallClock);
  LoopbackBus end = hub.open();
  NodeServer<LoopbackBus, Diary> server(hub.open(), Diary{});
  server.start();
  for (int i = 0; i < 10; ++i) {
    end.send(frame(kSync, {}));
    std::this_thread::sleep_for(milliseconds{1});
  }
  while (server.counts().received < 10) std::this_thread::sleep_for(milliseconds{1});
  server.stop();
  const auto entries = server.node().entries();
  ASSERT_EQ(entries.size(), 10U);
  for (const Diary::Entry& entry : entries.subspan(1)) {
    const double by_stamp = 1e-9 * static_cast<double>(entry.stamp - entries[0].stamp);
    EXPECT_NEAR(entry.at - entries[0].at, by_stamp, 0.2);  // not the 0.4 s it was held up
  }
}

}  // namespace
}  // namespace ebac::can::node_server_test
