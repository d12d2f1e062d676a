// The loop's side of the bus, against scripted drives.
#include "ebac/canopen/canopen_device.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "ebac/control/direct.hpp"
#include "ebac/loop/loop.hpp"
#include "ebac/loop/virtual_clock.hpp"
#include "ebac/simulated_drives/exchange_benchmark.hpp"
#include "scripted_drives.hpp"

namespace ebac::can::canopen_device_test {
namespace {

using Drives = ScriptedDrives;
using Tested = CanopenDevice<ScriptedBus, RunOther<Drives>>;
static_assert(Device<Tested>);

constexpr double kTick = 1e-3;  // s

/// A device, its bus and its drives.
struct TestBench {
  ScriptedBus bus;
  Drives drives;
  CanopenSetup setup;
  Tested device;

  explicit TestBench(const CanopenSetup& given = {.axes = 2})
      : drives{.bus = &bus, .nodes = given.axes},
        setup(given),
        device(bus, RunOther(drives), given) {}
  TestBench(const TestBench&) = delete;
  TestBench& operator=(const TestBench&) = delete;

  Reading tick(double first = 0, double second = 0) {
    return device.exchange({.current = {first, second}, .elapsed = kTick});
  }
  Reading ticks(int n) {
    Reading last;
    for (int i = 0; i < n; ++i) last = tick();
    return last;
  }
  void enable() {
    device.enable();
    for (int i = 0; i < 20 && !device.running(); ++i) tick();
    ASSERT_TRUE(device.running());
  }
  BusRow row(std::size_t axis = 0) const { return device.state(axis); }
};

double one() { return Motor{}.current(Motor{}.rated_torque) / 1000; }

TEST(DriveStates, AreReadFromEveryStatusword) {
  // CiA 402, table of the statusword: bits 0 to 3, 5 and 6 count, the others may be anything.
  for (unsigned word = 0; word < 0x10000; ++word) {
    const auto state = state_of(static_cast<std::uint16_t>(word));
    const unsigned low = word & 0x4F;
    const unsigned six = word & 0x6F;
    EXPECT_EQ(state == DriveState::kOperationEnabled, six == 0x27);
    EXPECT_EQ(state == DriveState::kSwitchedOn, six == 0x23);
    EXPECT_EQ(state == DriveState::kReady, six == 0x21);
    EXPECT_EQ(state == DriveState::kQuickStopActive, six == 0x07);
    EXPECT_EQ(state == DriveState::kSwitchOnDisabled, low == 0x40);
    EXPECT_EQ(state == DriveState::kFault, low == 0x08);
    EXPECT_EQ(state == DriveState::kFaultReaction, low == 0x0F);
  }
}

TEST(DriveStates, LeadUpAndDownByTheTableOfTheDrive) {
  for (std::size_t i = 0; i < kDriveStates; ++i) {
    const auto start = static_cast<DriveState>(i);
    EXPECT_EQ(state_of(status_bits(start)), start);
    DriveState up = start;
    DriveState down = start;
    for (int step = 0; step < 4; ++step) {
      up = after(up, up_from(up));
      down = after(down, down_from(down));
    }
    const bool stuck = faulty(start) || start == DriveState::kNotReady;
    EXPECT_EQ(up, stuck ? start : DriveState::kOperationEnabled) << i;
    EXPECT_EQ(down, stuck ? start : DriveState::kSwitchOnDisabled) << i;
  }
}

TEST(DriveStates, CommandsAreTheWordsTheDriveReads) {
  for (std::size_t i = 1; i < kDriveCommands; ++i) {
    const auto command = static_cast<DriveCommand>(i);
    EXPECT_EQ(command_of(word_of(command), 0), command) << i;
  }
}

TEST(Scale, IsThatOfEquationOne) {
  const Motor motor;
  const TorqueScale scale = TorqueScale::of(motor, {});
  EXPECT_DOUBLE_EQ(scale.current(500), copley_current(500, 5300, 5380));
  for (int permille = -4000; permille <= 4000; ++permille) {
    const auto word = static_cast<std::int16_t>(permille);
    EXPECT_EQ(scale.permille(scale.current(word)), permille);
    EXPECT_EQ(scale.current(word), one() * permille);
  }
}

TEST(Scale, HoldsTheLimits) {
  const double huge = std::numeric_limits<double>::max();
  const TorqueScale scale = TorqueScale::of({}, {});
  EXPECT_EQ(scale.permille(huge), 4000);
  EXPECT_EQ(scale.permille(-huge), -4000);
  EXPECT_EQ(scale.permille(kAnyHigh), 4000);
  EXPECT_EQ(scale.permille(std::numeric_limits<double>::quiet_NaN()), 0);
  EXPECT_EQ(scale.permille(0.49 * one()), 0);
  EXPECT_EQ(scale.permille(0.51 * one()), 1);
  // Sixteen bits are the last limit.
  const TorqueScale fine = TorqueScale::of({.rated_torque = 1e-4}, {.peak_ratio = 10});
  EXPECT_EQ(fine.permille(huge), 10000);
  EXPECT_EQ((TorqueScale{.one = 1e-6, .peak = 1, .most = 32767}).permille(1), 32767);
}

TEST(Setup, IsRefusedWithItsReason) {
  ScriptedBus bus;
  Drives drives{.bus = &bus};
  const auto make = [&](const CanopenSetup& setup) { Tested(bus, RunOther(drives), setup); };
  EXPECT_THROW(make({.axes = 0}), std::invalid_argument);
  EXPECT_THROW(make({.axes = 4}), std::invalid_argument);
  EXPECT_THROW(make({.axes = 2, .node = {1, 1}}), std::invalid_argument);
  EXPECT_THROW(make({.node = {0}}), std::invalid_argument);
  EXPECT_THROW(make({.node = {128}}), std::invalid_argument);
  EXPECT_THROW(make({.silent_ticks = 0}), std::invalid_argument);
  EXPECT_THROW(make({.motor = {.torque_constant = 0}}), std::invalid_argument);
  EXPECT_THROW(make({.axes = 2, .own_node = 2}), std::invalid_argument);  // a drive's heartbeat
  EXPECT_NO_THROW(make({.axes = 2, .own_node = 3}));
  EXPECT_NO_THROW(make({.axes = 1, .node = {127, 0, 0}}));
}

TEST(Exchange, SendsTorquesThenSync) {
  TestBench bench;
  bench.enable();
  bench.bus.full = false;
  ScriptedBus tap;
  bench.drives.bus = &tap;  // no node answers
  bench.tick(500 * one(), -20 * one());
  ASSERT_EQ(bench.bus.sent.size(), 3);
  EXPECT_EQ(bench.bus.sent[0], frame(0x201, {0x0F, 0x00, 0xF4, 0x01}));
  EXPECT_EQ(bench.bus.sent[1], frame(0x202, {0x0F, 0x00, 0xEC, 0xFF}));
  EXPECT_EQ(bench.bus.sent[2], frame(0x080, {}));
}

TEST(Exchange, IsToldWhatTheDrivesSay) {
  TestBench bench;
  bench.enable();
  bench.drives.drive[0].position = 12345;
  bench.drives.drive[1].position = -7;
  bench.tick(500 * one(), -20 * one());
  const Reading reading = bench.tick();
  EXPECT_EQ(reading.counts[0], 12345);
  EXPECT_EQ(reading.counts[1], -7);
  EXPECT_EQ(reading.current_applied[0], 500 * one());
  EXPECT_EQ(reading.current_applied[1], -20 * one());
  EXPECT_EQ(reading.fault, Fault::kNone);
  EXPECT_EQ(bench.row(0).age, 0);
  EXPECT_EQ(bench.row(0).statusword, 0x27);
}

TEST(Exchange, TellsTheOtherSideHowMuchTimePassed) {
  TestBench bench;
  bench.ticks(3);
  EXPECT_DOUBLE_EQ(bench.drives.elapsed, 3 * kTick);
  EXPECT_EQ(bench.drives.syncs, 3);
}

TEST(Counts, AreUnwrappedOverThirtyTwoBits) {
  TestBench bench;
  bench.enable();
  std::int64_t place = 2'000'000'000;
  bench.drives.drive[0].position = static_cast<std::int32_t>(place);
  // The first position of all is taken as it stands; from there on, the nearest.
  EXPECT_EQ(bench.tick().counts[0], place);
  for (int i = 0; i < 40; ++i) {
    place += i < 20 ? 1'000'000'000 : -2'000'000'000;
    bench.drives.drive[0].position = static_cast<std::int32_t>(static_cast<std::uint32_t>(place));
    EXPECT_EQ(bench.tick().counts[0], place) << i;
  }
}

TEST(Counts, AreThoseFromTheZeroOfTheEncoder) {
  TestBench bench({.axes = 2, .encoder_sign = {1, -1, 1}, .encoder_zero = {12345, -7}});
  EXPECT_EQ(bench.device.exchange({}).counts[0], -12345) << "the first position shown is 0";
  bench.enable();
  bench.drives.drive[0].position = 12345;
  bench.drives.drive[1].position = -7;
  EXPECT_EQ(bench.tick().counts[0], 0);
  EXPECT_EQ(bench.tick().counts[1], 0);
  bench.drives.drive[0].position = 12345 + 100;
  bench.drives.drive[1].position = -7 + 30;
  const Reading reading = bench.tick();
  EXPECT_EQ(reading.counts[0], 100);
  EXPECT_EQ(reading.counts[1], -30) << "the zero is the drive's, before its sign";
}

TEST(Counts, FromAZeroOnTheOtherSideOfTheWrapAreTheNearest) {
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();
  for (const std::int32_t zero : {kMost, kLeast, kMost - 3, 0, -1}) {
    for (const std::int64_t way : {-5, -1, 0, 1, 5, 2'000'000'000}) {
      TestBench bench({.axes = 1, .encoder_zero = {zero}});
      bench.drives.drive[0].position =
          static_cast<std::int32_t>(static_cast<std::uint32_t>(zero + way));
      EXPECT_EQ(bench.tick().counts[0], way) << zero;
    }
  }
}

TEST(EnableSequence, TakesTheDrivesUpOneStateAnExchange) {
  TestBench bench;
  std::vector<int> words;
  bench.tick(1);
  bench.device.enable();
  for (int i = 0; i < 5; ++i) {
    bench.tick(1, 1);
    words.push_back(bench.row().controlword);
    // No torque before all are enabled.
    EXPECT_EQ(bench.row().target_permille, i < 3 ? 0 : std::lround(1 / one())) << i;
  }
  EXPECT_EQ(words, (std::vector{0x06, 0x07, 0x0F, 0x0F, 0x0F}));
}

TEST(EnableSequence, NoTorqueUntilTheLastDriveIsEnabled) {
  TestBench bench;
  bench.drives.drive[1].stuck = true;
  bench.device.enable();
  for (int i = 0; i < 10; ++i) {
    bench.tick(1, 1);
    EXPECT_EQ(bench.row().target_permille, 0);
  }
  EXPECT_EQ(bench.row().statusword, 0x27);
  EXPECT_FALSE(bench.device.running());
}

TEST(EnableSequence, AtRestEveryExchangeSaysOff) {
  TestBench bench;
  for (int i = 0; i < 3; ++i) {
    bench.tick(1, 1);
    EXPECT_EQ(bench.row().controlword, 0);
    EXPECT_EQ(bench.row().target_permille, 0);
  }
  EXPECT_TRUE(bench.device.at_rest());
}

TEST(EnableSequence, OnlyAStateWithoutPowerIsRest) {
  TestBench bench({.axes = 1});
  bench.drives.drive[0].stuck = true;
  for (unsigned word = 0; word < 0x80; ++word) {
    bench.drives.drive[0].statusword = static_cast<std::uint16_t>(word);
    bench.tick();
    const unsigned low = word & 0x4F;
    EXPECT_EQ(bench.device.at_rest(), low == 0x40 || low == 0x08 || low == 0) << word;
  }
}

/// It may have heard the words that it does not answer.
TEST(EnableSequence, ADriveThatFallsSilentOnItsWayDownIsSwitchedOff) {
  TestBench bench({.axes = 2});
  bench.enable();
  bench.tick(1, 1);
  bench.drives.drive[1].copies = 0;
  bench.device.disable();
  bench.ticks(bench.setup.silent_ticks + 3);
  for (const auto& drive : {bench.drives.drive[0], bench.drives.drive[1]}) {
    EXPECT_EQ(drive.statusword, 0x40);
    EXPECT_EQ(drive.target, 0);
  }
  EXPECT_FALSE(bench.device.at_rest());  // nobody knows
}

TEST(EnableSequence, DisableGoesDownStepByStep) {
  TestBench bench;
  bench.enable();
  bench.tick(1, 1);
  bench.device.disable();
  std::vector<int> words;
  for (int i = 0; i < 5; ++i) {
    bench.tick(1, 1);
    words.push_back(bench.row().controlword);
    EXPECT_EQ(bench.row().target_permille, 0);
  }
  EXPECT_EQ(words, (std::vector{0x0F, 0x07, 0x06, 0x00, 0x00}));
  EXPECT_TRUE(bench.device.at_rest());
  EXPECT_EQ(bench.device.fault(), Fault::kNone);
}

TEST(EnableSequence, StopGoesTheShortestWay) {
  TestBench bench({.axes = 1});
  bench.enable();
  bench.tick(1);
  std::vector<int> words;
  for (int i = 0; i < 3; ++i) {
    bench.device.stop();
    bench.tick(1);
    words.push_back(bench.row().controlword);
    EXPECT_EQ(bench.row().target_permille, 0);
  }
  EXPECT_EQ(words, (std::vector{0x0F, 0, 0}));
  EXPECT_TRUE(bench.device.at_rest());
}

TEST(EnableSequence, AFaultOfItsOwnStopsUnasked) {
  TestBench bench;
  bench.enable();
  bench.tick(1, 1);
  bench.drives.drive[1].stuck = true;
  bench.drives.drive[1].statusword = 0x08;
  EXPECT_EQ(bench.tick(1, 1).fault, Fault::kDriveFault);
  bench.drives.drive[1].statusword = 0x40;
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(bench.tick(1, 1).fault, Fault::kDriveFault) << "stands";
    EXPECT_EQ(bench.row(0).target_permille, 0);
    EXPECT_EQ(bench.row(0).controlword, i == 0 ? 0x0F : 0x00);
    EXPECT_EQ(bench.row(1).controlword, 0x00);
  }
  bench.drives.drive[1].stuck = false;
  bench.enable();
  EXPECT_EQ(bench.tick().fault, Fault::kNone);
}

/// A fault of a running pair of drives, and after how many ticks it is seen.
struct InjectedFault {
  const char* name;
  void (*cause)(TestBench& bench);
  Fault fault;
  int ticks;
};
void PrintTo(const InjectedFault& trouble,
             std::ostream* out) {  // NOLINT: GoogleTest asks for the name
  *out << trouble.name;
}

class FaultOfADrive : public testing::TestWithParam<InjectedFault> {};

TEST_P(FaultOfADrive, IsTold) {
  TestBench bench({.axes = 2, .silent_ticks = 3, .heartbeat_timeout = 0.0105});
  bench.enable();
  const auto pulse = [&](NodeId node) { bench.bus.waiting.push_back(frame(heartbeat(node), {5})); };
  for (int i = 0; i < 30; ++i) {
    pulse(1);
    pulse(2);
    ASSERT_EQ(bench.tick(1, 1).fault, Fault::kNone);
  }
  GetParam().cause(bench);
  for (int i = 1; i < GetParam().ticks; ++i) ASSERT_EQ(bench.tick(1, 1).fault, Fault::kNone) << i;
  EXPECT_EQ(bench.tick(1, 1).fault, GetParam().fault);
  bench.tick(1, 1);
  EXPECT_EQ(bench.row(0).target_permille, 0);
  EXPECT_EQ(bench.row(1).target_permille, 0);
}

INSTANTIATE_TEST_SUITE_P(
    , FaultOfADrive,
    testing::Values(
        InjectedFault{
            "fault",
            [](TestBench& d) { d.drives.drive[1] = {.statusword = 0x1208, .stuck = true}; },
            Fault::kDriveFault, 1},
        InjectedFault{"reaction",
                      [](TestBench& d) { d.drives.drive[0] = {.statusword = 0x0F, .stuck = true}; },
                      Fault::kDriveFault, 1},
        InjectedFault{"disabled",
                      [](TestBench& d) { d.drives.drive[0] = {.statusword = 0x23, .stuck = true}; },
                      Fault::kDriveDisabled, 1},
        InjectedFault{"quick stop",
                      [](TestBench& d) { d.drives.drive[0] = {.statusword = 7, .stuck = true}; },
                      Fault::kDriveDisabled, 1},
        InjectedFault{"silent", [](TestBench& d) { d.drives.drive[1].copies = 0; },
                      Fault::kDriveSilent, 3},
        InjectedFault{"emergency",
                      [](TestBench& d) {
                        d.bus.waiting.push_back(frame(0x82, {0x10, 0x32, 4, 0, 0, 0, 0, 0}));
                      },
                      Fault::kDriveEmergency, 1},
        InjectedFault{"no heartbeat", [](TestBench&) {}, Fault::kHeartbeatLost, 11},
        InjectedFault{"rebooted", [](TestBench& d) { d.bus.waiting.push_back(frame(0x702, {0})); },
                      Fault::kHeartbeatLost, 1},
        InjectedFault{"pre-operational",
                      [](TestBench& d) { d.bus.waiting.push_back(frame(0x701, {0x7F})); },
                      Fault::kHeartbeatLost, 1},
        InjectedFault{"bus off", [](TestBench& d) { d.bus.now = BusState::kBusOff; },
                      Fault::kBusDown, 1},
        InjectedFault{"without commands, yet answering",
                      [](TestBench& d) { d.bus.refused_id = 0x202; }, Fault::kBusDown, 3},
        InjectedFault{"interface gone", [](TestBench& d) { d.bus.now = BusState::kDown; },
                      Fault::kBusDown, 1}));

/// Ticks until a torque is found that is not the loop's, or 100; `asked` A in tick `i`.
template <class Asked>
int until_mismatch(TestBench& bench, Asked asked) {
  int n = 1;
  while (n < 100 && bench.tick(asked(n), 0).fault == Fault::kNone) ++n;
  return n;
}

TEST(Torque, ThatWasNotCommandedIsAFault) {
  const auto found_after = [](int offset, int factor, double asked) {
    TestBench bench;
    bench.enable();
    bench.ticks(5);
    bench.drives.drive[0].offset = offset;
    bench.drives.drive[0].factor = factor;
    const int n = until_mismatch(bench, [&](int) { return asked; });
    if (n < 100) {
      EXPECT_EQ(bench.device.fault(), Fault::kTorqueMismatch);
      bench.tick(asked, 0);
      EXPECT_EQ(bench.row().target_permille, 0);
    }
    return n;
  };
  EXPECT_EQ(found_after(0, 1, 3.0), 100);
  EXPECT_EQ(found_after(4000, 1, 0), 11) << "an offset: the drive gives it one tick late";
  EXPECT_EQ(found_after(-150, 1, 0), 11);
  EXPECT_EQ(found_after(0, -1, 1.0), 11) << "the other sign";
  EXPECT_EQ(found_after(0, 2, 1.0), 11) << "another scale";
  EXPECT_EQ(found_after(0, 0, 3.0), 100) << "a drive that holds its torque back limits it";
  EXPECT_EQ(found_after(90, 1, 0), 100) << "noise of a current sensor";
}

TEST(Torque, MayLagAndBeNoisyButNotBeAnothersInEverySecondTick) {
  // Contact that chatters from end to end at every period, behind a lag of up to eight ticks.
  for (const int period : {2, 3, 7, 20}) {
    for (const int lag : {0, 1, 4, 8}) {
      TestBench bench;
      bench.enable();
      bench.drives.drive[0].factor = 0;  // what the drive gives is told below
      std::vector<int> asked(16, 0);
      for (int i = 0; i < 300; ++i) {
        const int torque = i % period < period / 2 + 1 ? 4000 : -4000;
        asked.push_back(torque);
        const auto late = asked[asked.size() - 2 - static_cast<std::size_t>(lag)];
        bench.drives.drive[0].offset = late;
        ASSERT_EQ(bench.tick(torque * one(), 0).fault, Fault::kNone) << period << ' ' << lag;
      }
    }
  }
  TestBench bench;
  bench.enable();
  int n = 0;
  for (; n < 100 && bench.device.fault() == Fault::kNone; ++n) {
    bench.drives.drive[0].offset = n % 2 == 0 ? 2000 : 0;
    bench.tick(0, 0);
  }
  EXPECT_EQ(bench.device.fault(), Fault::kTorqueMismatch);
  EXPECT_LT(n, 45);
}

TEST(Torque, IsComparedBeforeTheFirstCommandToo) {
  TestBench bench;
  bench.drives.drive[1].stuck = true;  // keeps the pair from being enabled
  bench.drives.drive[0].offset = 1500;
  bench.device.enable();
  const int n = until_mismatch(bench, [](int) { return 0.0; });
  EXPECT_LT(n, 20);
  EXPECT_EQ(bench.device.fault(), Fault::kTorqueMismatch);
}

TEST(SecondMaster, IsFoundByTheFirstFrame) {
  for (const Frame& stray : {frame(0x201, {0x0F, 0, 0xA0, 0x0F}), frame(0x202, {0x0F, 0, 0, 0}),
                             frame(0x080, {}), frame(0x764, {5})}) {
    TestBench bench({.axes = 2, .own_node = 100});
    bench.bus.waiting.push_back(stray);
    bench.tick();  // it is heard before the drives are enabled
    bench.enable();
    bench.bus.waiting.push_back(frame(0x181 + 2, {1}));  // of no concern
    bench.bus.waiting.push_back(frame(0x201 + 2, {1}));
    ASSERT_EQ(bench.tick(1, 1).fault, Fault::kNone);
    Frame own = stray;
    own.own = true;  // an echo of the loop's own
    bench.bus.waiting.push_back(own);
    ASSERT_EQ(bench.tick(1, 1).fault, Fault::kNone);
    bench.bus.waiting.push_back(stray);
    EXPECT_EQ(bench.tick(1, 1).fault, Fault::kSecondMaster) << stray.id;
    bench.tick(1, 1);
    EXPECT_EQ(bench.row(0).target_permille, 0);
    EXPECT_EQ(bench.row(1).target_permille, 0);
  }
}

/// Ticks until a second, different answer is found, where one comes every `period` ticks.
int until_duplicate(int period) {
  TestBench bench({.axes = 2});
  bench.enable();
  for (int i = 1; i < 300; ++i) {
    if (i % period == 0) bench.bus.waiting.push_back(answer(2, 0x27, 50, 0));
    if (bench.tick().fault == Fault::kDuplicateNode) return i;
  }
  return 0;
}

TEST(DuplicateNode, IsFoundByItsThirdAnswer) {
  EXPECT_EQ(until_duplicate(1), 3);
  EXPECT_EQ(until_duplicate(3), 9);
  EXPECT_EQ(until_duplicate(50), 0) << "one now and then is none";
}

TEST(DuplicateNode, IsNeitherADoubledFrameNorAnAnswerThatIsLate) {
  TestBench doubled({.axes = 1});
  doubled.drives.drive[0].copies = 2;
  doubled.enable();
  EXPECT_EQ(doubled.ticks(50).fault, Fault::kNone);
  TestBench late({.axes = 1, .silent_ticks = 50});
  late.enable();
  for (std::int32_t i = 0; i < 20; ++i) {
    late.drives.drive[0].position = i;
    late.drives.drive[0].copies = 0;
    late.tick();
    late.drives.drive[0].copies = 1;
    late.tick();
    late.bus.waiting.push_back(answer(1, 0x27, i - 1, 0));  // that of the tick before
    ASSERT_EQ(late.tick().fault, Fault::kNone) << i;
  }
}

TEST(DuplicateNode, IsNotABacklogOfADriveThatWasHeldUp) {
  TestBench bench({.axes = 1, .silent_ticks = 50});
  bench.enable();
  bench.drives.drive[0].copies = 0;
  bench.ticks(40);
  bench.drives.drive[0].copies = 1;
  for (std::int32_t i = 0; i < 40; ++i) bench.bus.waiting.push_back(answer(1, 0x27, i, 0));
  EXPECT_EQ(bench.ticks(3).fault, Fault::kNone);
  for (std::int32_t i = 0; i < 5; ++i) bench.bus.waiting.push_back(answer(1, 0x27, 99 + i, 0));
  EXPECT_EQ(bench.tick().fault, Fault::kDuplicateNode) << "nothing is owed any more";
}

TEST(Signs, TurnCurrentsAndCounts) {
  TestBench bench({.axes = 2, .motor_sign = {-1, 1, 1}, .encoder_sign = {1, -1, 1}});
  bench.enable();
  bench.drives.drive[0].position = bench.drives.drive[1].position = 700;
  bench.tick(0.1, 0.1);
  bench.tick(0.1, 0.1);
  const Reading reading = bench.tick(0.1, 0.1);
  EXPECT_EQ(bench.row(0).target_permille, -bench.row(1).target_permille);
  EXPECT_EQ(reading.counts[0], 700);
  EXPECT_EQ(reading.counts[1], -700);
  EXPECT_NEAR(reading.current_applied[0], 0.1, one());
  EXPECT_EQ(reading.current_applied[0], reading.current_applied[1]);
}

TEST(Signs, AreOneOrMinusOne) {
  ScriptedBus bus;
  Drives drives{.bus = &bus};
  EXPECT_THROW(Tested(bus, RunOther(drives), {.encoder_sign = {0, 1, 1}}), std::invalid_argument);
}

TEST(Enabling, TellsWhyItDoesNotSucceed) {
  const CanopenSetup hasty{.axes = 2, .enable_ticks = 20};
  const auto outcome = [&](auto change) {
    TestBench bench(hasty);
    change(bench);
    bench.device.enable();
    int n = 1;
    while (bench.tick().fault == Fault::kNone && n < 100) ++n;
    return std::pair{bench.device.fault(), n};
  };
  using Result = std::pair<Fault, int>;
  EXPECT_EQ(outcome([](TestBench& d) { d.drives.drive[1].stuck = true; }),
            Result(Fault::kDriveDisabled, 20));
  EXPECT_EQ(outcome([](TestBench& d) { d.drives.drive[0].copies = 0; }),
            Result(Fault::kDriveSilent, 20));
  EXPECT_EQ(outcome([](TestBench& d) { d.drives.drive[1] = {.statusword = 8, .stuck = true}; }),
            Result(Fault::kDriveFault, 1));
  EXPECT_EQ(outcome([](TestBench& d) { d.bus.now = BusState::kClosed; }),
            Result(Fault::kBusDown, 1));
}

TEST(Enabling, ForgetsTheEmergenciesOfTheStart) {
  TestBench bench;
  bench.bus.waiting.push_back(frame(0x81, {0x30, 0x81, 0, 0, 0, 0, 0, 0}));
  bench.enable();
  EXPECT_EQ(bench.tick().fault, Fault::kNone);
  EXPECT_EQ(bench.row().emergency, 0x8130);
  bench.bus.waiting.push_back(frame(0x81, {0, 0, 0, 0, 0, 0, 0, 0}));  // error reset
  EXPECT_EQ(bench.tick().fault, Fault::kNone);
}

TEST(Answers, MissingOnesAreCountedAndTheLastOneHolds) {
  TestBench bench;
  bench.enable();
  bench.drives.drive[0].position = 50;
  bench.tick();
  bench.drives.drive[0].copies = 0;
  bench.drives.drive[0].position = 60;
  const Reading held = bench.ticks(2);
  EXPECT_EQ(held.counts[0], 50);
  EXPECT_EQ(bench.row().missing, 2);
  EXPECT_EQ(bench.row().age, 2);
  EXPECT_EQ(bench.row(1).missing, 0);
  bench.drives.drive[0].copies = 1;
  EXPECT_EQ(bench.tick().counts[0], 60);
  EXPECT_EQ(bench.row().missing, 2);
  EXPECT_EQ(bench.row().age, 0);
}

TEST(Answers, LateOnesAreCountedAndUsed) {
  TestBench bench;
  bench.enable();
  bench.drives.drive[0].copies = 0;
  bench.tick();
  EXPECT_EQ(bench.row().missing, 1);
  bench.bus.waiting.push_back(answer(1, 0x27, 77, 0));  // after its tick was closed
  const Reading reading = bench.tick();
  EXPECT_EQ(reading.counts[0], 77);
  EXPECT_EQ(bench.row().late, 1);
  EXPECT_EQ(bench.row().duplicate, 0);
  EXPECT_EQ(bench.row().missing, 2) << "it answered the tick before, not this one";
  EXPECT_EQ(bench.row().age, 1);
}

TEST(Answers, CountsTellHowOldTheyAre) {
  TestBench bench;
  bench.enable();
  EXPECT_EQ(bench.tick().counts_age[0], 0);
  bench.drives.drive[0].copies = 0;
  EXPECT_EQ(bench.tick().counts_age[0], kTick);
  EXPECT_EQ(bench.tick().counts_age[0], 2 * kTick);
  bench.bus.waiting.push_back(
      answer(1, 0x27, 77, 0));  // to the last SYNC, after its tick was closed
  EXPECT_EQ(bench.tick().counts_age[0], kTick);
  bench.drives.drive[0].copies = 1;
  const Reading reading = bench.tick();
  EXPECT_EQ(reading.counts_age[0], 0);
  EXPECT_EQ(reading.counts_age[1], 0);
}

TEST(Answers, DuplicatesAreCounted) {
  TestBench bench;
  bench.enable();
  bench.drives.drive[0].copies = 3;
  bench.ticks(2);  // what comes after the last answer is read in the next tick
  bench.drives.drive[0].copies = 1;
  bench.tick();
  EXPECT_EQ(bench.row().duplicate, 4);
  EXPECT_EQ(bench.row(1).duplicate, 0);
  EXPECT_EQ(bench.row().missing, 0);
}

TEST(Answers, ForeignFramesAreCountedOnEveryAxis) {
  TestBench bench;
  const auto foreign = [&](Frame stray) {
    const auto before = bench.row().foreign;
    bench.bus.waiting.push_back(stray);
    bench.tick();
    EXPECT_EQ(bench.row(0).foreign, bench.row(1).foreign);
    return bench.row().foreign - before;
  };
  EXPECT_EQ(foreign(answer(3, 0x27, 5, 5)), 1) << "an unknown node";
  EXPECT_EQ(foreign(frame(0x281, {1, 2})), 1) << "a TPDO that is not planned";
  EXPECT_EQ(foreign(frame(0x201, {0x0F, 0, 1, 0})), 1) << "another master";
  EXPECT_EQ(foreign(frame(0x080, {})), 1) << "another SYNC";
  Frame odd = answer(1, 0x27, 5, 5);
  odd.extended = true;
  EXPECT_EQ(foreign(odd), 1);
  odd = answer(1, 0x27, 5, 5);
  odd.remote = true;
  EXPECT_EQ(foreign(odd), 1);
  odd = answer(1, 0x27, 5, 5);
  odd.error = true;
  EXPECT_EQ(foreign(odd), 1);
  EXPECT_EQ(foreign(frame(0x581, {0x60, 0, 0, 0, 0, 0, 0, 0})), 0) << "SDO beside the loop";
  EXPECT_EQ(foreign(frame(0x602, {0x40, 0, 0, 0, 0, 0, 0, 0})), 0);
  EXPECT_EQ(foreign(frame(0x000, {1, 0})), 0) << "NMT";
}

TEST(Answers, AreFoundInAFloodOfForeignFrames) {
  TestBench bench;
  bench.enable();
  for (int i = 0; i < 100; ++i) {
    bench.bus.waiting.insert(bench.bus.waiting.end(), 600, frame(0x3A5, {1, 2, 3}));
    bench.drives.drive[0].position = i;
    ASSERT_EQ(bench.tick(1, 1).fault, Fault::kNone) << i;
    ASSERT_EQ(bench.row().age, 0);
  }
  EXPECT_EQ(bench.row().missing, 0);
}

TEST(Answers, MalformedOnesAreNotRead) {
  TestBench bench;
  bench.enable();
  bench.drives.drive[0].copies = 0;
  Frame brief = answer(1, 0x27, 99, 99);
  brief.size = 7;
  bench.bus.waiting = {brief, frame(0x81, {1}), frame(0x701, {5, 5})};
  const Reading reading = bench.tick();
  EXPECT_EQ(reading.counts[0], 0);
  EXPECT_EQ(bench.row().malformed, 3);
  EXPECT_EQ(bench.row().missing, 1);
  EXPECT_EQ(reading.fault, Fault::kNone);
}

TEST(Answers, RefusedFramesAreCounted) {
  TestBench bench;
  bench.enable();
  bench.bus.full = true;
  bench.tick();
  EXPECT_EQ(bench.row(0).refused, 2) << "its torque, and SYNC";
  EXPECT_EQ(bench.row(1).refused, 2);
  EXPECT_EQ(bench.row(0).missing, 1);
}

/// Polls until the budget is spent, by the time that `Now` returns in ns.
template <class Now>
  requires requires(Now now) {
    { now() } noexcept -> std::same_as<std::int64_t>;
  }
class PollFor {
 public:
  PollFor(Now now, std::int64_t budget) EBAC_RT : now_(std::move(now)), budget_(budget) {}  // ns

  void begin(double) EBAC_RT { end_ = now_() + budget_; }
  bool more() EBAC_RT { return now_() < end_; }

 private:
  Now now_;
  std::int64_t budget_;   // ns
  std::int64_t end_ = 0;  // ns
};

/// Time that passes by 10 us whenever it is asked.
struct Counter {
  std::int64_t* now;
  std::int64_t operator()() const noexcept { return *now += 10'000; }
};

TEST(Budget, IsNotExceeded) {
  ScriptedBus bus;
  std::int64_t now = 0;
  CanopenDevice<ScriptedBus, PollFor<Counter>> device(bus, PollFor(Counter{&now}, 400'000),
                                                      {.axes = 2});
  static_cast<void>(device.exchange({}));
  EXPECT_GE(now, 400'000);
  EXPECT_LE(now, 430'000);
  // A flood does not hold it up either.
  bus.waiting.assign(5000, frame(0x123, {}));
  now = 0;
  static_cast<void>(device.exchange({}));
  EXPECT_LE(now, 430'000);
  EXPECT_GE(bus.waiting.size(), 5000 - 2 * 1024);
  // With every answer there, it does not wait at all.
  bus.waiting.clear();
  now = 0;
  AnsweringBus prompt(2);
  CanopenDevice<AnsweringBus, PollFor<Counter>> quick(prompt, PollFor(Counter{&now}, 400'000),
                                                      {.axes = 2});
  static_cast<void>(quick.exchange({}));
  EXPECT_EQ(now, 10'000);
}

TEST(InTheLoop, AFaultOfAnotherStageStopsTheDrives) {
  TestBench bench({.axes = 1});
  bench.enable();
  /// Answers no number from tick 5 on.
  struct Broken {
    struct State {
      static constexpr auto fields() { return std::array<Field<State>, 0>{}; }
    };
    int tick = 0;
    void step(std::span<Axis> axes, const ContactForce&) EBAC_RT {
      axes[0].port.f_cmd = tick++ < 5 ? 1.0 : std::nan("");
    }
    void reset() EBAC_RT {}
  };
  Loop loop(bench.device, VirtualClock(kTick, 0, 1), Broken{},
            SignalChain(DeviceModel{}, Environment{Free{}}, {}), 1);
  const auto trace = loop.make_trace(100);
  loop.run(*trace);
  ASSERT_EQ(trace->size(), 15);
  EXPECT_EQ(trace->sample(14).fault, Fault::kLawNotFinite);
  EXPECT_EQ(bench.drives.drive[0].controlword, 0);
  EXPECT_EQ(bench.drives.drive[0].target, 0);
  EXPECT_TRUE(loop.device().at_rest());
  EXPECT_FALSE(loop.device().running());
  const auto& columns = trace->columns();
  EXPECT_TRUE(
      std::ranges::any_of(columns, [](const Column& c) { return c.name == "bus.missing"; }));
}

}  // namespace
}  // namespace ebac::can::canopen_device_test
