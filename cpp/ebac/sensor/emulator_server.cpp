#include "ebac/sensor/emulator_server.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace ebac::sensor {

EmulatorServer::EmulatorServer(const Endpoint& at, const RdtEmulator<Endpoint>& emulator,
                               Source source)
    : socket_(at), emulator_(emulator), source_(std::move(source)), local_(socket_.local()) {}

void EmulatorServer::start(rt::Mode mode, const rt::Options& options) {
  thread_.start("this sensor has been on the network already: make a new one", mode, options,
                [this] { work(); });
}

void EmulatorServer::stop() noexcept {
  thread_.stop([this] { socket_.close(); });
}

void EmulatorServer::set(const EmulatorTrouble& trouble) {
  check(trouble, "EmulatorTrouble");
  const std::scoped_lock one(posting_);
  trouble_.post(trouble);
}

EmulatorCounts EmulatorServer::counts() const {
  EmulatorCounts counts;
  for (std::size_t i = 0; const FieldRow& field : field_table<EmulatorCounts>().rows) {
    const std::int64_t value = published_[i++].load(std::memory_order_relaxed);
    if (field.kind == FieldKind::kInt64) field.in<std::int64_t>(&counts) = value;
  }
  return counts;
}

/// A thread that is late takes the samples it missed, up to a few: a sensor has a buffer, too.
void EmulatorServer::work() noexcept {
  constexpr int kMostMissed = 100;
  constexpr std::chrono::nanoseconds kLongestNap = std::chrono::milliseconds{5};
  const auto period =
      std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / emulator_.options().rate));
  for (auto due = Steady::now() + period; !thread_.over();) {
    const auto left = due - Steady::now();
    if (left.count() > 0) socket_.wait(std::min<std::chrono::nanoseconds>(left, kLongestNap));
    hear();
    if (const EmulatorTrouble* trouble = trouble_.take()) emulator_.set(*trouble);
    for (; due <= Steady::now() && !thread_.over(); due += period) {
      const auto missed = (Steady::now() - due) / period;
      if (missed > kMostMissed) due += (missed - kMostMissed) * period;
      sample(period);
    }
    publish_counts();
  }
}

void EmulatorServer::hear() noexcept {
  constexpr int kMostRequests = 64;
  Datagram in;
  for (int i = 0; i < kMostRequests; ++i) {
    const int error = socket_.receive(in);
    if (error == EAGAIN) return;
    if (error == 0) emulator_.hear(in.bytes(), in.from);
  }
}

void EmulatorServer::sample(std::chrono::nanoseconds period) noexcept {
  emulator_.feel(source_(std::chrono::duration<double>(period).count()));
  emulator_.sample([this](std::span<const std::uint8_t> bytes, const Endpoint& to) noexcept {
    static_cast<void>(socket_.send(bytes, to));
  });
}

void EmulatorServer::publish_counts() noexcept {
  for (std::size_t i = 0; const FieldRow& field : field_table<EmulatorCounts>().rows) {
    if (field.kind == FieldKind::kInt64) {
      const auto value = field.in<std::int64_t>(&emulator_.counts());
      published_[i].store(value, std::memory_order_relaxed);
    }
    ++i;
  }
}

}  // namespace ebac::sensor
