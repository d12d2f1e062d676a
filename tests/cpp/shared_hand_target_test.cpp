// Target of a simulated hand: from the updates of a loop, through a shared target, to another process.
#include "ebac/rt/shared_hand_target.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <limits>
#include <memory>
#include <system_error>

#include "ebac/sim/simulated_device.hpp"

namespace ebac::rt::shared_hand_target_test {
namespace {

constexpr double kStay = std::numeric_limits<double>::quiet_NaN();
constexpr double kDt = 1e-3;  // s

TEST(SharedHandTarget, GivesTheNewestOnce) {
  SharedHandTarget cell;
  EXPECT_EQ(cell.take(), nullptr);
  cell.post({.target = {1, 2, 3}});
  cell.post({.target = {4, 5, 6}});
  const HandTarget* aim = cell.take();
  ASSERT_NE(aim, nullptr);
  EXPECT_EQ(aim->target[0], 4);
  EXPECT_EQ(cell.take(), nullptr);
}

TEST(SharedHandTarget, IsOneInTwoProcesses) {
  SharedHandTarget cell;
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    SharedHandTarget same(cell.descriptor());
    same.post({.target = {0.5, kStay, 0}});
    _exit(0);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  const HandTarget* aim = cell.take();
  ASSERT_NE(aim, nullptr);
  EXPECT_EQ(aim->target[0], 0.5);
}

TEST(SharedMemory, RefusesWhatIsNone) {
  const SharedMemory small(16);
  EXPECT_THROW(SharedMemory(small.descriptor(), 17), std::invalid_argument);
  EXPECT_THROW(SharedMemory(-1, 16), std::system_error);
  const SharedMemory same(small.descriptor(), 16);
  static_cast<char*>(small.at())[7] = 42;
  EXPECT_EQ(static_cast<char*>(same.at())[7], 42);
}

/// Counts what it is asked, and never moves.
struct Still {
  int exchanges = 0;
  Reading exchange(const Command&) EBAC_RT {
    ++exchanges;
    return {};
  }
};

TEST(TargetPublisher, PassesATargetOnWithTheNextExchangeAndOnlyOnce) {
  const auto cell = std::make_shared<SharedHandTarget>();
  TargetPublisher device(Still{}, cell);
  device.aim(1, 0.02);
  EXPECT_EQ(cell->take(), nullptr);
  static_cast<void>(device.exchange({}));
  const HandTarget* aim = cell->take();
  ASSERT_NE(aim, nullptr);
  EXPECT_EQ(aim->target[1], 0.02);
  static_cast<void>(device.exchange({}));
  EXPECT_EQ(cell->take(), nullptr);
  TargetPublisher alone(Still{});
  alone.aim(0, 0.01);
  EXPECT_EQ(alone.exchange({}).fault, Fault::kNone);
}

TEST(TargetSubscriber, TheHandGoesThereAndAnAxisThatIsNotToldStays) {
  ebac::Setup setup;
  setup.device.kinematics = Linear{.axes = 2};
  setup.hand.path = {MinimumJerk{.target = 0.01, .duration = 0.1}, Step{.target = 0}, Step{}};
  const auto cell = std::make_shared<SharedHandTarget>();
  TargetSubscriber device(SimulatedDevice(setup), cell);
  for (int i = 0; i < 500; ++i) static_cast<void>(device.exchange({.elapsed = kDt}));
  cell->post({.target = {-0.02, kStay, kStay}});
  TargetSubscriber peek = device;  // who looks while no time passes takes nothing away
  static_cast<void>(peek.exchange({}));
  for (int i = 0; i < 3000; ++i) static_cast<void>(device.exchange({.elapsed = kDt}));
  EXPECT_NEAR(device.device().state(0).x, -0.02, 1e-3);
  EXPECT_EQ(device.device().state(1).x, 0);
}

}  // namespace
}  // namespace ebac::rt::shared_hand_target_test
