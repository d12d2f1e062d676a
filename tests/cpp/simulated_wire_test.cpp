// The wire of a CAN bus: lengths, order, conservation, errors.
#include "ebac/simulated_drives/simulated_wire.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string_view>
#include <vector>

#include "ebac/can/frame_length.hpp"
#include "ebac/canopen/pdo_plan.hpp"

namespace ebac::can::simulated_wire_test {
namespace {

constexpr std::int64_t kLong = 1'000'000'000;  // ns

Frame random_frame(Noise& random) {
  Frame made{.id = static_cast<std::uint32_t>(random.bits() & kStandardIds),
             .size = static_cast<std::uint8_t>(random.bits() % 9)};
  for (std::size_t i = 0; i < made.size; ++i)
    made.data[i] = static_cast<std::uint8_t>(random.bits());
  return made;
}

TEST(FrameLength, TheChecksumIsThatOfTheCatalogue) {
  StuffedBits bits;  // CRC-15/CAN of "123456789" (catalogue of parametrised CRC algorithms)
  for (const char c : std::string_view("123456789")) bits.push(static_cast<std::uint8_t>(c), 8);
  EXPECT_EQ(bits.crc(), 0x059E);
}

TEST(FrameLength, LiesBetweenTheBounds) {
  Noise random(1);
  for (int i = 0; i < 10'000; ++i) {
    const Frame made = random_frame(random);
    EXPECT_LE(least_bits(made.size), exact_bits(made));
    EXPECT_LE(exact_bits(made), worst_bits(made.size));
  }
  EXPECT_EQ(priority({.id = 0x80}) < priority({.id = 0x81}), true);
  EXPECT_LT(priority({.id = 0x123}), priority({.id = 0x123, .remote = true}));
  EXPECT_LT(priority({.id = 0x123, .remote = true}),
            priority({.id = 0x123U << 18U, .extended = true}));
}

struct Sent {
  Frame frame;
  std::size_t from;
  std::int64_t due;
};

/// Frames of four stations at random times, in the order of their times.
std::vector<Sent> traffic(std::uint64_t seed) {
  Noise random(seed);
  std::vector<Sent> all;
  std::int64_t due = 0;
  for (int i = 0; i < 100; ++i) {
    due += static_cast<std::int64_t>(random.bits() % 150'000);
    all.push_back({random_frame(random), random.bits() % 4, due});
  }
  return all;
}

std::vector<SimulatedWire::Delivery> carry(const std::vector<Sent>& all, WireOptions options) {
  options.stations = 4;
  SimulatedWire wire(options);
  std::vector<SimulatedWire::Delivery> came;
  SimulatedWire::Delivery one;
  for (const Sent& sent : all) {
    while (wire.next(sent.due, one)) came.push_back(one);
    EXPECT_TRUE(wire.send(sent.from, sent.frame, sent.due));
  }
  while (wire.next(kLong, one)) came.push_back(one);
  return came;
}

TEST(SimulatedWire, EveryFrameArrivesOnceInTheOrderOfItsStation) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto all = traffic(seed);
    for (const double error_rate : {0.0, 0.05}) {
      const auto came = carry(all, {.error_rate = error_rate, .seed = seed});
      ASSERT_EQ(came.size(), all.size());
      for (std::size_t station = 0; station < 4; ++station) {
        std::vector<Frame> in, out;
        for (const Sent& one : all) {
          if (one.from == station) in.push_back(one.frame);
        }
        for (const auto& one : came) {
          if (one.from == station) out.push_back(one.frame);
        }
        EXPECT_EQ(in, out);
      }
    }
  }
}

TEST(SimulatedWire, NoFrameOvertakesOneThatWaitsWithAHigherPriority) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto all = traffic(seed);
    const auto came = carry(all, {});
    std::array<std::vector<const Sent*>, 4> queue;
    for (const Sent& one : all) queue[one.from].push_back(&one);
    std::array<std::size_t, 4> at{};
    std::int64_t free_at = 0;
    for (const auto& one : came) {
      const Sent& mine = *queue[one.from][at[one.from]];
      const std::int64_t begun = one.frame.stamp - 1000LL * exact_bits(one.frame);
      EXPECT_GE(begun, free_at);
      EXPECT_GE(begun, mine.due);
      bool waited = begun == mine.due || begun == free_at;  // the wire is never idle for nothing
      for (std::size_t other = 0; other < 4; ++other) {
        if (other == one.from || at[other] == queue[other].size()) continue;
        const Sent& rival = *queue[other][at[other]];
        if (rival.due > begun) continue;
        EXPECT_LE(priority(mine.frame), priority(rival.frame));
      }
      EXPECT_TRUE(waited);
      free_at = one.frame.stamp;
      ++at[one.from];
    }
  }
}

TEST(SimulatedWire, GivesTheSameAgainAndOtherErrorsWithAnotherSeed) {
  const auto all = traffic(3);
  const auto ends = [&](std::uint64_t seed) {
    std::vector<std::int64_t> times;
    for (const auto& one : carry(all, {.error_rate = 0.1, .seed = seed})) {
      times.push_back(one.frame.stamp);
    }
    return times;
  };
  EXPECT_EQ(ends(1), ends(1));
  EXPECT_NE(ends(1), ends(2));
}

TEST(SimulatedWire, ABrokenStationIsPassiveThenOffTheBusAndComesBack) {
  SimulatedWire wire({.stations = 2});
  wire.set_error_rate(1, 1);
  SimulatedWire::Delivery one;
  std::int64_t now = 0;
  EXPECT_TRUE(wire.send(1, {.id = 0x181, .size = 8}, 0));
  BusState last = BusState::kUp;
  std::vector<BusState> states{last};
  while (!wire.off(1)) {
    EXPECT_FALSE(wire.next(now += 10'000, one));
    if (wire.state(1) != last) states.push_back(last = wire.state(1));
  }
  EXPECT_EQ(states, (std::vector{BusState::kUp, BusState::kWarning, BusState::kPassive,
                                 BusState::kBusOff}));
  EXPECT_EQ(wire.destroyed(), 32);  // 8 each, to above 255
  EXPECT_FALSE(wire.send(1, {.id = 0x181}, now));
  EXPECT_FALSE(wire.next(now + 128 * 11 * 1000 - 50'000, one));
  EXPECT_TRUE(wire.off(1));
  EXPECT_FALSE(wire.next(now + 128 * 11 * 1000 + 50'000, one));
  EXPECT_FALSE(wire.off(1));
  EXPECT_EQ(wire.state(1), BusState::kUp);
}

TEST(SimulatedWire, AStationAloneIsPassiveAndNeverOff) {
  SimulatedWire wire({.stations = 1});
  EXPECT_TRUE(wire.send(0, {.id = 0x80}, 0));
  SimulatedWire::Delivery one;
  EXPECT_FALSE(wire.next(kLong, one));
  EXPECT_EQ(wire.state(0), BusState::kPassive);
}

TEST(SimulatedWire, RefusesWhatNoBusIs) {
  EXPECT_THROW(SimulatedWire({.stations = 0}), std::invalid_argument);
  EXPECT_THROW(SimulatedWire({.bit_rate = 5e6}), std::invalid_argument);
  EXPECT_THROW(SimulatedWire({.error_rate = 2}), std::invalid_argument);
  try {
    SimulatedWire({.bit_rate = 5e6});
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "SimulatedWire.bit_rate = 5e+06 bit/s: must lie in [10000, 1e+06] bit/s");
  }
  SimulatedWire wire({});
  for (int i = 0; i < 64; ++i) EXPECT_TRUE(wire.send(0, {.id = 1}, 0));
  EXPECT_FALSE(wire.send(0, {.id = 1}, 0));
  EXPECT_FALSE(wire.send(1, {.id = 0x800}, 0));
}

TEST(SimulatedWire, TimeEndsBeforeItsNumbersDo) {
  SimulatedWire wire({});
  SimulatedWire::Delivery came;
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  EXPECT_FALSE(wire.send(0, {.id = 1}, kMost - 1));
  EXPECT_TRUE(wire.send(0, {.id = 1}, std::numeric_limits<std::int64_t>::min()));
  ASSERT_TRUE(wire.next(kMost, came));
  EXPECT_EQ(came.frame.stamp, exact_bits({.id = 1}) * 1000);
  EXPECT_FALSE(wire.next(kMost - 1, came));
  EXPECT_TRUE(wire.send(0, {.id = 1}, 0));
  EXPECT_FALSE(wire.next(kMost, came));
}

}  // namespace
}  // namespace ebac::can::simulated_wire_test
