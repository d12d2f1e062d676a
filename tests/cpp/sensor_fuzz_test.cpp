// A million packets of nonsense, a quarter of them under sanitizers, and sockets that take anything: nothing crashes, all is counted.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <vector>

#include "ebac/model/noise.hpp"
#include "ebac/sensor/emulator.hpp"
#include "ebac/sensor/rdt_client.hpp"
#include "rounds.hpp"

namespace ebac::sensor::sensor_fuzz_test {
namespace {

constexpr int kPackets = rounds(1'000'000);

/// A record, or something like it.
std::size_t nonsense(Noise& random, std::span<std::uint8_t> bytes, std::uint32_t& number) {
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.bits());
  const std::uint64_t kind = random.bits() % 4;
  if (kind == 0) return random.bits() % bytes.size();
  if (kind == 1) number += static_cast<std::uint32_t>(random.bits() % 200) - 90;
  if (kind > 1) ++number;
  if (kind > 0 && random.bits() % 100 != 0) wire::put(bytes, 0, number);
  return random.bits() % 50 == 0 ? random.bits() % bytes.size() : RdtRecord::kBytes;
}

TEST(RdtFuzz, PacketsOfNonsense) {
  Noise random(2026);
  RdtLink link({.scale = {.counts_per_force = 1e-3, .force_range = 50}});
  RdtEmulator<int> emulator;
  std::array<std::uint8_t, 64> bytes{};
  std::uint32_t number = 4'294'900'000;
  std::int64_t good = 0;
  std::int64_t wrong = 0;
  for (int i = 0; i < kPackets; ++i) {
    const std::size_t size = nonsense(random, bytes, number);
    const auto packet = std::span(bytes).first(size);
    if (size != RdtRecord::kBytes) ++wrong;
    good += link.take(packet) ? 1 : 0;
    if (i % 1000 == 0) link.begin_bias(1 + static_cast<int>(random.bits() % 500));
    if (i % 7 == 0)
      wire::put(bytes, 0, 0x12340000U | static_cast<std::uint32_t>(random.bits() % 5));
    emulator.hear(std::span(bytes).first(random.bits() % 3 == 0 ? 8 : size), 1);
    emulator.sample([&](std::span<const std::uint8_t> out, int) {
      ASSERT_LE(out.size(), RdtEmulator<int>::kMostBytes);
    });
    if (!(link.force().allFinite() && link.torque().allFinite())) FAIL() << "packet " << i;
  }
  const StreamOrder& order = link.order();
  EXPECT_GT(good, kPackets / 10 * 3);
  EXPECT_EQ(good, link.received());
  EXPECT_EQ(link.malformed(), wrong + order.stray());
  EXPECT_EQ(good + order.late() + order.duplicate() + order.stray() + wrong, kPackets);
  EXPECT_GE(order.lost(), 0);
}

TEST(RdtFuzz, TheSocketTakesAnything) {
  UdpSocket sensor(Endpoint{.address = kLoopbackAddress});
  RdtClient client({.sensor = sensor.local()});
  client.start();
  Noise random(5);
  std::vector<std::uint8_t> bytes(2000);
  std::int64_t sent = 0;
  std::uint32_t number = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::size_t size = nonsense(random, std::span(bytes).first(64), number);
    if (random.bits() % 20 == 0) size = random.bits() % bytes.size();
    if (sensor.send(std::span(bytes).first(size), client.local()) == 0) ++sent;
    if (i % 20 == 0) client.poll(1e-3);
  }
  client.wait(std::chrono::milliseconds{100});
  client.poll(1e-3);
  const StreamOrder& order = client.link().order();
  const RdtRow& row = client.state(0);
  EXPECT_EQ(row.received + row.late + row.duplicate + row.malformed, sent);
  EXPECT_EQ(row.foreign, 0);
  EXPECT_GT(order.lost(), 0);
}

}  // namespace
}  // namespace ebac::sensor::sensor_fuzz_test
