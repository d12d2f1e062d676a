// The client over real sockets on loopback: scripted packets, an emulator in real time, and ports
// where no program listens.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <thread>

#include "ebac/sensor/emulator_server.hpp"
#include "ebac/sensor/rdt_client.hpp"

namespace ebac::sensor::sensor_udp_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const Endpoint kAnyPort{.address = kLoopbackAddress};

/// A sensor that says what a test writes, and its client, which has asked for a stream.
struct Script {
  UdpSocket sensor{kAnyPort};
  RdtClient client{{.sensor = sensor.local(), .stamped = false}};
  Datagram asked{};

  Script() {
    client.start();
    hears();
  }
  /// The next request.
  bool hears() { return sensor.wait(seconds{5}) && sensor.receive(asked) == 0; }
  void say(std::span<const std::uint8_t> bytes) {
    ASSERT_EQ(sensor.send(bytes, client.local()), 0);
    ASSERT_TRUE(client.wait(seconds{5}));
  }
  void say(std::uint32_t number, std::int32_t x = 0, std::uint32_t status = 0) {
    say(encode(RdtRecord{.rdt_sequence = number, .status = status, .force = {x, 0, 0}}));
  }
};

TEST(EmulatorServer, SeveralThreadsMayStopIt) {
  for (int i = 0; i < 20; ++i) {
    EmulatorServer server(kAnyPort, RdtEmulator<Endpoint>(),
                          [](double) { return EmulatorServer::Force{}; });
    server.start();
    std::atomic<int> ready{0};
    const auto stop = [&] {
      ready.fetch_add(1);
      while (ready.load() < 2) std::this_thread::yield();
      server.stop();
    };
    std::thread other(stop);
    stop();
    other.join();
  }
}

TEST(RdtClient, AsksAndCountsExactly) {
  Script s;
  RdtRequest request;
  ASSERT_TRUE(decode(s.asked.bytes(), request));
  EXPECT_EQ(request, (RdtRequest{.command = 2, .samples = 0}));
  EXPECT_EQ(s.client.state(), LinkState::kWaiting);
  EXPECT_EQ(s.client.health(), SensorStatus::kDisconnected);

  s.say(1, 1'000'000);
  s.say(2, 2'000'000);
  s.say(2, 9'000'000);                     // again
  s.say(6, 6'000'000);                     // 3, 4 and 5 are missing
  s.say(4, 9'000'000);                     // one comes late
  s.say(std::array<std::uint8_t, 35>{});   // short
  s.say(std::array<std::uint8_t, 37>{});   // long
  s.say(std::span<const std::uint8_t>{});  // empty
  UdpSocket stranger(kAnyPort);
  stranger.send(encode(RdtRecord{.rdt_sequence = 7}), s.client.local());
  EXPECT_TRUE(s.client.poll(1e-3));
  EXPECT_EQ(s.client.state(), LinkState::kStreaming);

  Reading reading;
  s.client.fill(reading);
  EXPECT_EQ(reading.force[0], 6);  // the newest, not the last
  EXPECT_EQ(reading.force_age, 0);
  EXPECT_EQ(reading.force_status, SensorStatus::kGood);
  const RdtRow& row = s.client.state(0);
  EXPECT_EQ(row.received, 3);
  EXPECT_EQ(row.lost, 2);
  EXPECT_EQ(row.late, 1);
  EXPECT_EQ(row.duplicate, 1);
  EXPECT_EQ(row.malformed, 3);
  EXPECT_EQ(row.foreign, 1);
}

TEST(RdtClient, AgeIsTheTimeWithoutANewerRecord) {
  Script s;
  s.say(1);
  s.client.poll(1e-3);
  for (int k = 1; k <= 100; ++k) {
    s.client.poll(1e-3);
    ASSERT_NEAR(s.client.age(), 1e-3 * k, 1e-12);
    ASSERT_EQ(s.client.state(0).age, s.client.age());
  }
  s.say(1);  // an old one makes nothing newer
  EXPECT_FALSE(s.client.poll(1e-3));
  EXPECT_NEAR(s.client.age(), 0.101, 1e-12);
  s.say(2);
  EXPECT_TRUE(s.client.poll(1e-3));
  EXPECT_EQ(s.client.age(), 0);
}

TEST(Age, IsNoLongerThanTheTimeSinceTheLastPollWhateverTheWallClockDoes) {
  constexpr std::int64_t kMs = 1'000'000, kSecond = 1000 * kMs, kStamp = 1'700'000'000 * kSecond;
  EXPECT_DOUBLE_EQ(record_age(kStamp, kStamp + kMs / 2, kMs), 0.5e-3);
  EXPECT_DOUBLE_EQ(record_age(kStamp, kStamp + kSecond, kMs), 1e-3) << "it stepped by a second";
  EXPECT_DOUBLE_EQ(record_age(kStamp, kStamp - kSecond, kMs), 0) << "and back";
}

/// Linux begins to stamp packets on arrival some time after the first socket asks for it; until then
/// a stamp is the time of reading. Returns a socket that keeps the stamps on.
UdpSocket stamps_on_arrival() {
  UdpSocket socket(kAnyPort);
  const auto now = [] {
    const auto since = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::nanoseconds(since).count();
  };
  for (int i = 0; i < 200; ++i) {
    socket.send(std::array<std::uint8_t, 1>{}, socket.local());
    std::this_thread::sleep_for(milliseconds{5});
    Datagram in;
    if (socket.receive(in) == 0 && now() - in.stamp > 4'000'000) break;
  }
  return socket;
}

TEST(RdtClient, AgeCountsFromWhenTheKernelHadTheRecord) {
  const UdpSocket stamping = stamps_on_arrival();
  UdpSocket sensor(kAnyPort);
  RdtClient client({.sensor = sensor.local()});
  client.start();
  const auto sent = std::chrono::steady_clock::now();  // or a little before
  sensor.send(encode(RdtRecord{.rdt_sequence = 1}), client.local());
  std::this_thread::sleep_for(milliseconds{30});
  EXPECT_TRUE(client.poll(0));
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - sent;
  EXPECT_GE(client.age(), 0.029);
  EXPECT_LE(client.age(), passed.count() + 0.001);
}

TEST(RdtClient, WhoReadsSeldomDoesNotAskAgain) {
  const UdpSocket stamping = stamps_on_arrival();
  UdpSocket sensor(kAnyPort);
  RdtClient client({.sensor = sensor.local(), .retry = 0.02});
  client.start();
  sensor.send(encode(RdtRecord{.rdt_sequence = 1}), client.local());
  std::this_thread::sleep_for(milliseconds{40});  // it waits in the queue, as old as silence
  EXPECT_TRUE(client.poll(0.04));
  EXPECT_GT(client.age(), 0.02);
  EXPECT_EQ(client.asked(), 1);
}

TEST(RdtClient, ASilentSensorIsAskedAgainAndThenGone) {
  Script s;
  s.say(5);
  s.client.poll(0);
  s.client.poll(0.3);  // 0.25 s of silence
  EXPECT_TRUE(s.hears());
  EXPECT_EQ(s.client.asked(), 2);
  EXPECT_EQ(s.client.state(), LinkState::kStreaming);
  s.client.poll(0.24);
  EXPECT_EQ(s.client.state(), LinkState::kSilent);
  EXPECT_EQ(s.client.health(), SensorStatus::kDisconnected);
  s.say(1);  // it begins anew
  EXPECT_TRUE(s.client.poll(1e-3));
  EXPECT_EQ(s.client.state(), LinkState::kStreaming);
  EXPECT_EQ(s.client.state(0).lost, 0);
}

TEST(RdtClient, AnotherStreamBeginsWithNothingOfTheOldOne) {
  Script s;
  s.say(500, 9'000'000);
  s.client.start();  // the record still waits
  EXPECT_FALSE(s.client.poll(0));
  s.say(1, 1'000'000);
  EXPECT_TRUE(s.client.poll(1e-3));
  EXPECT_EQ(s.client.link().force()[0], 1);
  EXPECT_EQ(s.client.state(0).lost + s.client.state(0).malformed, 0);
}

TEST(RdtClient, StopsAStreamAndASensorsBiasIsItsOwn) {
  Script s;
  RdtRequest request;
  s.client.bias_sensor();
  ASSERT_TRUE(s.hears() && decode(s.asked.bytes(), request));
  EXPECT_EQ(request.command, 0x42);
  s.client.stop();
  ASSERT_TRUE(s.hears() && decode(s.asked.bytes(), request));
  EXPECT_EQ(request.command, 0);
  EXPECT_EQ(s.client.state(), LinkState::kStopped);
  for (int k = 0; k < 10; ++k) s.client.poll(0.3);
  EXPECT_FALSE(s.sensor.wait(milliseconds{5}));  // it does not ask again
  s.client.start();
  ASSERT_TRUE(s.hears());
  s.client.close();
  ASSERT_TRUE(s.hears() && decode(s.asked.bytes(), request));
  EXPECT_EQ(request.command, 0);
  EXPECT_FALSE(s.client.poll(1));
  EXPECT_EQ(s.client.state(), LinkState::kClosed);
  s.client.start();
  s.client.bias_sensor();
  EXPECT_EQ(s.client.state(), LinkState::kClosed);
  EXPECT_FALSE(s.sensor.wait(milliseconds{5}));
}

TEST(RdtClient, AWaitEndsWhenAnotherThreadCloses) {
  Script s;
  auto waiting = std::async(std::launch::async, [&] { s.client.wait(seconds{5}); });
  std::this_thread::sleep_for(milliseconds{20});
  const Endpoint at = s.client.local();
  s.client.close();
  EXPECT_EQ(waiting.wait_for(seconds{3}), std::future_status::ready);
  // The number of its socket is not that of another file, for which a wait that begins now would wait.
  EXPECT_EQ(s.client.local(), at);
  waiting.get();
}

TEST(RdtClient, NobodyThereIsAState) {
  Endpoint nobody;
  {
    const UdpSocket gone(kAnyPort);
    nobody = gone.local();
  }
  RdtClient client({.sensor = nobody});
  client.start();
  for (int k = 0; k < 500 && client.state() != LinkState::kRefused; ++k) {
    std::this_thread::sleep_for(milliseconds{1});
    client.poll(1e-3);
  }
  EXPECT_EQ(client.state(), LinkState::kRefused);
  EXPECT_EQ(client.health(), SensorStatus::kDisconnected);
  UdpSocket sensor(nobody);  // it is switched on
  for (int k = 0; k < 500 && client.state() != LinkState::kStreaming; ++k) {
    client.poll(0.05);
    Datagram in;
    if (sensor.wait(milliseconds{1}) && sensor.receive(in) == 0) {
      sensor.send(encode(RdtRecord{.rdt_sequence = 1}), in.from);
    }
  }
  EXPECT_EQ(client.state(), LinkState::kStreaming);
}

TEST(RdtClient, RefusesASetupThatCannotBe) {
  EXPECT_THROW(RdtClient({.sensor = {.address = kLoopbackAddress}}), std::invalid_argument);
  EXPECT_THROW(RdtClient({.sensor = {1, 1}, .retry = 0}), std::invalid_argument);
  EXPECT_THROW(RdtClient({.sensor = {1, 1}, .gone = std::nan("")}), std::invalid_argument);
  EXPECT_THROW(RdtClient({.sensor = {1, 1}, .link = {.scale = {.counts_per_force = 0}}}),
               std::invalid_argument);
  EXPECT_THROW(resolve("no such host", 1), std::invalid_argument);
  EXPECT_EQ(to_string(resolve("127.0.0.1", 49152)), "127.0.0.1:49152");
  const UdpSocket taken(kAnyPort);
  EXPECT_THROW(UdpSocket{taken.local()}, std::system_error);
}

TEST(EmulatorServer, StreamsToWhoAsks) {
  auto cell = std::make_shared<Mailbox<EmulatorServer::Force>>();
  EmulatorServer sensor(kAnyPort, RdtEmulator<Endpoint>({.rate = 2000}), from_cell(cell));
  sensor.start();
  EXPECT_THROW(sensor.start(), std::logic_error);
  cell->post({3, -2, 1});
  RdtClient client({.sensor = sensor.local()});
  client.start();
  for (int k = 0; k < 5000 && client.state(0).received < 200; ++k) {
    client.wait(milliseconds{10});
    client.poll(1e-3);
  }
  EXPECT_GE(client.state(0).received, 200);
  EXPECT_TRUE(client.link().force().isApprox(Axes(3, -2, 1)));
  client.begin_bias(50);
  for (int k = 0; k < 5000 && client.link().biasing(); ++k) {
    client.wait(milliseconds{10});
    client.poll(1e-3);
  }
  client.poll(0);
  EXPECT_TRUE(client.link().force().isZero(1e-9));
  sensor.stop();
  EXPECT_GE(sensor.counts().sent, 200);
  EXPECT_EQ(sensor.counts().requests, 1);
}

TEST(EmulatorServer, IsSilentForGoodOnceStopped) {
  EmulatorServer sensor(kAnyPort, RdtEmulator<Endpoint>(),
                        [](double) { return EmulatorServer::Force{}; });
  sensor.stop();
  EXPECT_THROW(sensor.start(), std::logic_error);
}

/// Everything that threads may do to it at once, for the thread sanitizer.
TEST(EmulatorServer, IsUsedFromManyThreads) {
  auto cell = std::make_shared<Mailbox<EmulatorServer::Force>>();
  EmulatorServer sensor(kAnyPort, RdtEmulator<Endpoint>({.rate = 7000}), from_cell(cell));
  sensor.start();
  std::atomic<bool> over = false;
  std::thread hand([&] {
    for (double f = 0; !over; f += 0.01) cell->post({f, 0, 0});
  });
  std::thread troubled([&] {
    for (int i = 0; !over; ++i) sensor.set({.loss = 0.1 * (i % 5), .duplicate = 0.1});
  });
  std::thread watching([&] {
    while (!over) static_cast<void>(sensor.counts());
  });
  RdtClient client({.sensor = sensor.local()});
  client.start();
  for (int k = 0; k < 20'000 && client.state(0).received < 300; ++k) {
    client.wait(milliseconds{10});
    client.poll(1e-3);
  }
  over = true;
  hand.join();
  troubled.join();
  watching.join();
  sensor.stop();
  EXPECT_GE(client.state(0).received, 300);
}

/// A hand that takes longer to simulate than the sensor's period: the sensor falls behind, and still ends.
TEST(EmulatorServer, StopsWhereItsSourceIsTooSlow) {
  auto sensor =
      std::make_unique<EmulatorServer>(kAnyPort, RdtEmulator<Endpoint>({.rate = 1000}), [](double) {
        std::this_thread::sleep_for(milliseconds{2});
        return EmulatorServer::Force{};
      });
  sensor->start();
  std::this_thread::sleep_for(milliseconds{20});
  auto stopping = std::async(std::launch::async, [&] { sensor->stop(); });
  ASSERT_EQ(stopping.wait_for(seconds{10}), std::future_status::ready);
}

}  // namespace
}  // namespace ebac::sensor::sensor_udp_test
