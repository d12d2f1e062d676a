// The loop's own heartbeat, by which drives notice that the loop is gone.
#include <gtest/gtest.h>

#include <vector>

#include "ebac/canopen/canopen_device.hpp"
#include "scripted_drives.hpp"

namespace ebac::can::own_heartbeat_test {
namespace {

constexpr double kTick = 1e-3;  // s

/// The other side of the bus: drives, and the ticks in which they heard the loop's heartbeat.
struct Listeners {
  ScriptedDrives drives;
  Frame beat;
  std::vector<int> heard{};
  int tick = 0;

  void run(double elapsed) noexcept {
    for (const Frame& frame : drives.bus->sent) {
      if (frame == beat) heard.push_back(tick);
    }
    ++tick;
    drives.run(elapsed);
  }
};

/// Ticks in which the heartbeat of node 100 was heard: at rest, enabled and stopped.
std::vector<int> heard(const CanopenSetup& setup) {
  ScriptedBus bus;
  Listeners listeners{.drives = {.bus = &bus}, .beat = frame(0x764, {5})};  // 0x700 + 100
  CanopenDevice<ScriptedBus, RunOther<Listeners>> device(bus, RunOther(listeners), setup);
  for (int i = 0; i < 300; ++i) {
    if (i == 100) device.enable();
    if (i == 200) {
      EXPECT_TRUE(device.running());
      device.stop();
    }
    device.exchange({.elapsed = kTick});
  }
  return listeners.heard;
}

TEST(OwnHeartbeat, IsHeardAtItsPeriodInEveryState) {
  for (const int period : {2, 10, 25}) {  // ticks
    // Half a tick less, for sums of a tick are not whole.
    const auto beats = heard({.own_node = 100, .heartbeat_period = (period - 0.5) * kTick});
    int last = 0;  // one sent at the end of a tick is heard in the next one
    for (const int tick : beats) {
      EXPECT_EQ(tick - last, period);
      last = tick;
    }
    EXPECT_GE(last, 300 - period);
  }
}

TEST(OwnHeartbeat, IsNotSentByALoopThatIsNoNode) { EXPECT_TRUE(heard({.own_node = 0}).empty()); }

}  // namespace
}  // namespace ebac::can::own_heartbeat_test
