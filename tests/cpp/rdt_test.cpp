// The protocol of the force sensor, without a network: bytes, order, units, axes, status.
#include "ebac/sensor/rdt.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "ebac/model/noise.hpp"
#include "ebac/sensor/rdt_link.hpp"

namespace ebac::sensor::rdt_test {
namespace {

TEST(Rdt, BytesAreThoseOfTheManual) {
  const auto start = encode(RdtRequest{.command = 2, .samples = 0});
  EXPECT_EQ(start, (std::array<std::uint8_t, 8>{0x12, 0x34, 0, 2, 0, 0, 0, 0}));
  const auto bytes = encode(RdtRecord{.rdt_sequence = 1,
                                      .ft_sequence = 0x01020304,
                                      .status = 0x80020000,
                                      .force = {-1, 1'000'000, -2147483648},
                                      .torque = {0, 256, 2147483647}});
  const std::array<std::uint8_t, 36> wanted{
      0,    0,    0,    1, 1, 2, 3, 4, 0x80, 2, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0,    0x0F,
      0x42, 0x40, 0x80, 0, 0, 0, 0, 0, 0,    0, 0, 0, 1,    0,    0x7F, 0xFF, 0xFF, 0xFF};
  EXPECT_EQ(bytes, wanted);
}

TEST(Rdt, WhatIsEncodedIsDecoded) {
  Noise random(7);
  const auto any = [&] { return static_cast<std::uint32_t>(random.bits()); };
  const auto count = [&] { return static_cast<std::int32_t>(any()); };
  for (int i = 0; i < 10'000; ++i) {
    const RdtRecord record{.rdt_sequence = any(),
                           .ft_sequence = any(),
                           .status = any(),
                           .force = {count(), count(), count()},
                           .torque = {count(), count(), count()}};
    RdtRecord back;
    ASSERT_TRUE(decode(encode(record), back));
    ASSERT_EQ(back, record);
    const RdtRequest request{.command = static_cast<std::uint16_t>(any()), .samples = any()};
    RdtRequest again;
    ASSERT_TRUE(decode(encode(request), again));
    ASSERT_EQ(again, request);
  }
}

TEST(Rdt, OtherLengthsAndHeadersAreNoPackets) {
  std::array<std::uint8_t, 64> bytes{};
  RdtRecord record;
  RdtRequest request;
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    EXPECT_EQ(decode(std::span(bytes).first(size), record), size == 36);
    EXPECT_FALSE(decode(std::span(bytes).first(size), request));
  }
}

/// What a stream is, counted the slow way: every number that came.
struct SlowCount {
  std::set<std::uint64_t> came;
  std::int64_t late = 0, duplicate = 0;
  std::uint64_t first = 0;

  void take(std::uint64_t number) {
    if (came.empty()) first = number;
    if (came.contains(number)) {
      ++duplicate;
    } else if (!came.empty() && number < *came.rbegin()) {
      ++late;
    }
    came.insert(number);
  }
  std::int64_t lost() const {
    const auto within = std::distance(came.lower_bound(first), came.end());
    return static_cast<std::int64_t>(*came.rbegin() - first + 1) - within;
  }
};

TEST(StreamOrder, CountsLikeTheSlowWayWhateverComes) {
  Noise random(3);
  for (int run = 0; run < 300; ++run) {
    StreamOrder order;
    SlowCount slow;
    std::uint64_t next =
        (std::uint64_t{1} << 32U) - 50 + random.bits() % 40;  // it wraps on the way
    for (int i = 0; i < 400; ++i) {
      const std::uint64_t kind = random.bits() % 10;
      std::uint64_t number = next;
      if (kind == 0) number = next += random.bits() % 5;      // some are lost
      if (kind == 1) number = next - 1 - random.bits() % 20;  // old or doubled
      if (kind > 1 || number == next) next = number + 1;
      slow.take(number);
      order.take(static_cast<std::uint32_t>(number));
      ASSERT_EQ(order.lost(), slow.lost()) << run << " " << i;
      ASSERT_EQ(order.late(), slow.late) << run << " " << i;
      ASSERT_EQ(order.duplicate(), slow.duplicate) << run << " " << i;
    }
    ASSERT_EQ(order.stray(), 0);
  }
}

TEST(StreamOrder, OneStrayNumberIsNotBelievedTwoAreANewStream) {
  StreamOrder order;
  for (std::uint32_t n = 1000; n < 1010; ++n) order.take(n);
  EXPECT_EQ(order.take(3'000'000'000), Arrival::kStray);
  EXPECT_EQ(order.take(1010), Arrival::kNewest);
  EXPECT_EQ(order.lost(), 0);
  EXPECT_EQ(order.take(1), Arrival::kStray);  // the sensor began anew
  EXPECT_EQ(order.take(2), Arrival::kNewest);
  EXPECT_EQ(order.take(3), Arrival::kNewest);
  EXPECT_EQ(order.restarts(), 1);
  EXPECT_EQ(order.lost(), 0);
  order.restart();
  EXPECT_EQ(order.take(77), Arrival::kNewest);
  EXPECT_EQ(order.lost(), 0);
}

TEST(StreamOrder, AStreamThatWasAskedForMayFollowTheEndOfTheOldOne) {
  StreamOrder order;
  for (std::uint32_t n = 1000; n < 1010; ++n) order.take(n);
  order.restart();
  EXPECT_EQ(order.take(1010), Arrival::kNewest);  // was under way
  EXPECT_EQ(order.take(1), Arrival::kNewest);
  for (std::uint32_t n = 2; n < 100; ++n) EXPECT_EQ(order.take(n), Arrival::kNewest);
  EXPECT_EQ(order.lost() + order.stray() + order.late(), 0);
  EXPECT_EQ(order.take(1'000'000'000), Arrival::kStray);  // once only
}

/// A stream that is asked for twice, as by opening a sensor and then by enabling a device: where one
/// record of a short old stream was still under way, all of the new one up to its number counted as
/// late, and the force went stale.
TEST(StreamOrder, AnOldStreamHoweverShortDoesNotHideTheNewOne) {
  for (std::uint32_t last = 2; last < 200; ++last) {
    StreamOrder order;
    std::uint32_t sample = 0xFFFFFF00;  // it wraps on the way
    for (std::uint32_t n = 1; n < last; ++n) order.take(n, ++sample);
    order.restart();
    ASSERT_EQ(order.take(last, ++sample), Arrival::kNewest);
    for (std::uint32_t n = 1; n < 300; ++n) {
      ASSERT_EQ(order.take(n, ++sample), Arrival::kNewest) << last << " " << n;
    }
    ASSERT_EQ(order.late() + order.lost() + order.duplicate() + order.stray(), 0);
  }
}

TEST(StreamOrder, APacketThatWasOvertakenIsLateInANewStreamToo) {
  StreamOrder order;
  order.restart();
  EXPECT_EQ(order.take(2, 102), Arrival::kNewest);
  EXPECT_EQ(order.take(1, 101), Arrival::kLate);
  EXPECT_EQ(order.take(3, 103), Arrival::kNewest);
  EXPECT_EQ(order.take(3, 103), Arrival::kDuplicate);
  EXPECT_EQ(order.late(), 1);
  EXPECT_EQ(order.lost(), 0);
}

RdtRecord pushing(std::uint32_t number, double x, double y = 0, double z = 0) {
  const auto counts = [](double newton) { return static_cast<std::int32_t>(1e6 * newton); };
  return {.rdt_sequence = number, .force = {counts(x), counts(y), counts(z)}};
}

TEST(RdtLink, TurnsCountsIntoNewtonsAtTheHandle) {
  // 90 degrees about z: the sensor's x is the handle's y.
  RdtLink link({.scale = {.counts_per_force = 1e6, .counts_per_torque = 2e6},
                .mounting = {.rotation = {0, -1, 0, 1, 0, 0, 0, 0, 1}}});
  RdtRecord record = pushing(1, 3, 0.5, -2);
  record.torque = {1'000'000, 0, 0};
  ASSERT_TRUE(link.take(encode(record)));
  EXPECT_TRUE(link.force().isApprox(Axes(-0.5, 3, -2)));
  EXPECT_TRUE(link.torque().isApprox(Axes(0, 0.5, 0)));
}

TEST(RdtLink, TakesTheMeanOfGoodRecordsAsZero) {
  RdtLink link({});
  link.begin_bias(4);
  for (std::uint32_t n = 1; n <= 5; ++n) {
    RdtRecord record = pushing(n, 1 + 0.1 * n);
    if (n == 2) record.status = StatusBits::kAnyError | 1;  // does not count
    EXPECT_TRUE(link.biasing());
    link.take(encode(record));
  }
  EXPECT_FALSE(link.biasing());
  EXPECT_DOUBLE_EQ(link.bias()[0], 1e6 * (1.1 + 1.3 + 1.4 + 1.5) / 4);
  link.take(encode(pushing(6, 2)));
  EXPECT_NEAR(link.force()[0], 2 - 1.325, 1e-12);
}

TEST(RdtLink, OldAndDoubleRecordsChangeNothing) {
  RdtLink link({});
  EXPECT_TRUE(link.take(encode(pushing(10, 1))));
  EXPECT_FALSE(link.take(encode(pushing(10, 2))));
  EXPECT_FALSE(link.take(encode(pushing(9, 2))));
  EXPECT_FALSE(link.take(std::array<std::uint8_t, 35>{}));
  EXPECT_DOUBLE_EQ(link.force()[0], 1);
  EXPECT_EQ(link.received(), 1);
  EXPECT_EQ(link.malformed(), 1);
}

TEST(RdtLink, KnowsWhatStatusBitsSay) {
  const auto of = [](SensorModel model, std::uint32_t status) {
    return StatusBits::of(model).judge(status);
  };
  using enum SensorStatus;
  EXPECT_EQ(of(SensorModel::kNetFt, 0), kGood);
  EXPECT_EQ(of(SensorModel::kNetFt, 0x00010000), kGood);  // a monitor condition
  EXPECT_EQ(of(SensorModel::kNetFt, 0x80020000), kSaturated);
  EXPECT_EQ(of(SensorModel::kNetFt, 0x80000000), kError);
  EXPECT_EQ(of(SensorModel::kNetFt, 0x80020004), kError);  // saturated and too warm
  EXPECT_EQ(of(SensorModel::kAxia, 0xC0000000), kSaturated);
  EXPECT_EQ(of(SensorModel::kAxia, 0x88000000), kSaturated);
  EXPECT_EQ(of(SensorModel::kAxia, 0x80000004), kError);  // broken gage
  EXPECT_EQ(of(SensorModel::kAxia, 0x00000008), kGood);   // busy
  EXPECT_EQ(of(SensorModel::kOther, 0x00010000), kError);
}

TEST(RdtLink, TheEndOfTheRangeIsSaturatedWhateverTheStatus) {
  RdtLink link({.scale = {.force_range = 50}});
  link.take(encode(pushing(1, -49.9)));
  EXPECT_EQ(link.health(), SensorStatus::kGood);
  link.take(encode(pushing(2, 0, -50)));
  EXPECT_EQ(link.health(), SensorStatus::kSaturated);
  RdtLink trusting({});
  trusting.take(encode(RdtRecord{.rdt_sequence = 1, .force = {0, 0, -2147483648}}));
  EXPECT_EQ(trusting.health(), SensorStatus::kSaturated);
}

TEST(Mounting, RefusesWhatIsNoRotation) {
  const auto refused = [](Mounting mounting, const char* why) {
    try {
      check_mounting(mounting);
      ADD_FAILURE() << why;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  refused({.rotation = {1, 0, 0, 0, 2, 0, 0, 0, 1}}, "rows 1 and 1");
  refused({.rotation = {1, 0, 0, 1, 0, 0, 0, 0, 1}}, "rows 0 and 1");
  refused({.rotation = {1, 0, 0, 0, 1, 0, 0, 0, -1}}, "mirror");
  refused({.rotation = {std::nan(""), 0, 0, 0, 1, 0, 0, 0, 1}}, "rows 0 and 0");
  refused({.sign = 0}, "sign = 0");
  const double s = std::numbers::sqrt2 / 2;
  EXPECT_NO_THROW(check_mounting({.rotation = {s, -s, 0, s, s, 0, 0, 0, 1}, .sign = -1}));
}

TEST(Mounting, ThereAndBackIsNothing) {
  const double s = std::numbers::sqrt2 / 2;
  const Mounting mounting{.rotation = {s, -s, 0, s, s, 0, 0, 0, 1}, .sign = -1};
  const Axes force(1, 2, 3);
  EXPECT_TRUE(mounting.to_handle(mounting.to_sensor(force)).isApprox(force));
  EXPECT_TRUE(mounting.to_handle(Axes(1, 0, 0)).isApprox(Axes(-s, -s, 0)));
}

}  // namespace
}  // namespace ebac::sensor::rdt_test
