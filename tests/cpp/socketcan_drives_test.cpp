// The loop's device on SocketCAN, against drives in another process: tests/python/test_socketcan_drives.py starts and
// configures them, and then this. EBAC_CAN_DRIVES names the interface they are on.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "ebac/can/socketcan.hpp"
#include "timed_run.hpp"

namespace ebac::can::socketcan_drives_test {
namespace {

TEST(SocketCanDrives, RunUnderTorqueAndRestAfterwards) {
  const char* interface = std::getenv("EBAC_CAN_DRIVES");
  if (interface == nullptr) GTEST_SKIP() << "EBAC_CAN_DRIVES names no interface with drives on it";
  constexpr int kTicks = 200;
  constexpr double kCurrent = 0.2;  // A: about 2 N at the handle
  SocketCan bus(interface);
  const TimedRun run = run_in_real_time(bus, kTicks, kCurrent);
  std::cout << kTicks << " ticks of 1 ms on " << interface << ": " << run.late << " late, "
            << run.missing << " answers of drive 1 not in their tick, axis 0 moved by "
            << run.last - run.first << " counts\n";
  EXPECT_TRUE(run.ran);
  EXPECT_EQ(run.fault, Fault::kNone);
  EXPECT_NEAR(run.current_echoed, kCurrent, 1e-3);
  EXPECT_GT(std::abs(run.last - run.first), 20);  // counts: the hand gives way
  EXPECT_TRUE(run.rested);
  EXPECT_EQ(bus.state(), BusState::kUp);
}

}  // namespace
}  // namespace ebac::can::socketcan_drives_test
