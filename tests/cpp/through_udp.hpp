#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <utility>

#include "ebac/sensor/emulator.hpp"
#include "ebac/sensor/rdt_client.hpp"
#include "ebac/sensor/shared_force.hpp"
#include "ebac/sensor/udp.hpp"

namespace ebac::sensor {

/// A sensor on loopback and its client, in one thread and in step: at each poll the emulator hears,
/// samples and sends, and what it sent is there before the client looks.
class StepSensor {
 public:
  using State = RdtClient::State;
  static constexpr std::string_view kPrefix = RdtClient::kPrefix;

  explicit StepSensor(std::shared_ptr<SharedForce> cell, const EmulatorOptions& options = {},
                      const Mounting& mounting = {}, const FtScale& scale = {})
      : cell_(std::move(cell)), bench_(std::make_unique<TestBench>(options, mounting, scale)) {
    bench_->client.start();
  }

  bool poll(double elapsed) noexcept {
    TestBench& d = *bench_;
    if (const auto* force = cell_->take()) d.emulator.feel(*force);
    for (Datagram in; d.socket.receive(in) == 0;) d.emulator.hear(in.bytes(), in.from);
    bool sent = false;
    d.emulator.sample([&](std::span<const std::uint8_t> bytes, const Endpoint& to) {
      sent = d.socket.send(bytes, to) == 0 || sent;
    });
    if (sent) d.client.wait(std::chrono::seconds{5});
    return d.client.poll(elapsed);
  }
  void fill(Reading& reading) const noexcept { bench_->client.fill(reading); }
  SensorStatus health() const noexcept { return bench_->client.health(); }
  const State& state(std::size_t axis) const noexcept { return bench_->client.state(axis); }

  RdtClient& client() { return bench_->client; }
  RdtEmulator<Endpoint>& emulator() { return bench_->emulator; }

 private:
  struct TestBench {
    TestBench(const EmulatorOptions& options, const Mounting& mounting, const FtScale& scale)
        : emulator(options, mounting),
          client({.sensor = socket.local(),
                  .link = {.scale = scale, .mounting = mounting},
                  .stamped = false}) {}
    UdpSocket socket{Endpoint{.address = kLoopbackAddress}};
    RdtEmulator<Endpoint> emulator;
    RdtClient client;
  };
  std::shared_ptr<SharedForce> cell_;
  std::unique_ptr<TestBench> bench_;
};

}  // namespace ebac::sensor
