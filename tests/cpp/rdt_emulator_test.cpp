// The emulated sensor, without a network: what it does, and that its client counts what it does badly.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ebac/sensor/emulator.hpp"
#include "ebac/sensor/rdt_link.hpp"

namespace ebac::sensor::rdt_emulator_test {
namespace {

/// An emulator and a link, hand to hand.
struct Pair {
  RdtEmulator<int> emulator;
  RdtLink link{{}};
  std::vector<std::vector<std::uint8_t>> packets{};

  void ask(RdtCommand command, std::uint32_t samples = 0) {
    emulator.hear(encode(RdtRequest{static_cast<std::uint16_t>(command), samples}), 5);
  }
  void sample(int times = 1) {
    for (int i = 0; i < times; ++i) {
      emulator.sample([&](std::span<const std::uint8_t> bytes, int to) {
        EXPECT_EQ(to, 5);
        packets.emplace_back(bytes.begin(), bytes.end());
        link.take(bytes);
      });
    }
  }
};

TEST(RdtEmulator, DoesWhatItIsAsked) {
  Pair p{RdtEmulator<int>({.load = 7})};
  p.sample(3);
  EXPECT_TRUE(p.packets.empty());
  p.ask(RdtCommand::kStart);
  p.emulator.feel({2, 0, 0});
  p.sample(4);
  EXPECT_TRUE(p.link.force().isApprox(Axes(2, 0, 7)));
  EXPECT_TRUE(p.link.torque().isApprox(Axes(0, 0.02 * 2, 0)));  // the hand holds 20 mm ahead
  EXPECT_EQ(p.link.record().rdt_sequence, 4U);
  EXPECT_EQ(p.link.record().ft_sequence, 7U);
  p.ask(RdtCommand::kBias);
  p.sample();
  EXPECT_TRUE(p.link.force().isZero());
  p.ask(RdtCommand::kStop);
  p.sample(5);
  EXPECT_EQ(p.packets.size(), 5U);
  p.link.restart();
  p.ask(RdtCommand::kStart, 3);
  p.sample(10);
  EXPECT_EQ(p.packets.size(), 8U);
  EXPECT_EQ(p.emulator.counts().requests, 4);
  p.emulator.hear(encode(RdtRequest{.command = 99}), 5);
  p.emulator.hear(std::array<std::uint8_t, 3>{}, 5);
  EXPECT_EQ(p.emulator.counts().refused, 2);
}

TEST(RdtEmulator, GivesSeveralRecordsAPacketWhereAsked) {
  Pair p{RdtEmulator<int>({.buffer = 4})};
  p.ask(RdtCommand::kStartBuffered, 10);
  p.sample(20);
  ASSERT_EQ(p.packets.size(), 3U);  // 4, 4 and the 2 that are left
  EXPECT_EQ(p.packets[0].size(), 4 * RdtRecord::kBytes);
  EXPECT_EQ(p.packets[2].size(), 2 * RdtRecord::kBytes);
}

TEST(RdtEmulator, SaturatesAtItsRangeWhereverZeroIs) {
  Pair p{RdtEmulator<int>({.force_range = 50})};
  p.ask(RdtCommand::kStart);
  p.emulator.feel({30, 0, 0});
  p.ask(RdtCommand::kBias);
  p.emulator.feel({49, 0, 0});
  p.sample();
  EXPECT_EQ(p.link.health(), SensorStatus::kGood);
  p.emulator.feel({80, 0, 0});
  p.sample();
  EXPECT_EQ(p.link.health(), SensorStatus::kSaturated);
  EXPECT_DOUBLE_EQ(p.link.force()[0], 20);
  p.emulator.feel({std::nan(""), 0, 0});
  p.sample();
  EXPECT_EQ(p.link.health(), SensorStatus::kSaturated);
}

TEST(RdtEmulator, TakesNoZeroFromALoadThatIsNoNumber) {
  Pair p{RdtEmulator<int>()};
  p.ask(RdtCommand::kStart);
  p.emulator.feel({std::nan(""), 0, 0});
  p.ask(RdtCommand::kBias);
  p.emulator.feel({1, 0, 0});
  p.sample();
  EXPECT_DOUBLE_EQ(p.link.force()[0], 1);
}

TEST(RdtEmulator, WhatItDoesBadlyIsWhatTheLinkCounts) {
  Pair p{RdtEmulator<int>()};
  p.ask(RdtCommand::kStart);
  p.sample();  // the first one comes
  p.emulator.set({.loss = 0.1, .duplicate = 0.1, .reorder = 0.1});
  p.sample(20'000);
  p.emulator.set({});
  p.sample(2);  // what was held back leaves, and the last one comes
  const EmulatorCounts& did = p.emulator.counts();
  EXPECT_NEAR(static_cast<double>(did.dropped), 2000, 200);
  EXPECT_GT(did.doubled, 1200);
  EXPECT_GT(did.swapped, 1200);
  EXPECT_EQ(p.link.order().lost(), did.dropped);
  EXPECT_EQ(p.link.order().duplicate(), did.doubled);
  EXPECT_EQ(p.link.order().late(), did.swapped);
  EXPECT_EQ(p.link.received() + did.dropped + did.swapped, 20'003);
}

}  // namespace
}  // namespace ebac::sensor::rdt_emulator_test
