#pragma once

#include <chrono>
#include <utility>
#include <variant>

#include "ebac/can/loopback_bus.hpp"
#include "ebac/can/socketcan.hpp"

namespace ebac::can {

/// One end of a bus inside this process or of the kernel, as it was opened. One thread.
class AnyBus {
 public:
  explicit AnyBus(LoopbackBus bus) noexcept : bus_(std::move(bus)) {}
  explicit AnyBus(SocketCan bus) noexcept : bus_(std::move(bus)) {}

  bool send(const Frame& out) noexcept {
    return std::visit([&](auto& bus) noexcept { return bus.send(out); }, bus_);
  }
  bool receive(Frame& in) noexcept {
    if (!waits_) return std::visit([&](auto& bus) noexcept { return bus.receive(in); }, bus_);
    in = ahead_;
    waits_ = false;
    return true;
  }
  /// Sleeps until a frame is there to be received: false after `most`.
  bool wait(std::chrono::nanoseconds most) noexcept {
    if (!waits_) {
      waits_ = std::visit([&](auto& bus) noexcept { return bus.receive(ahead_, most); }, bus_);
    }
    return waits_;
  }

  BusState state() const noexcept {
    return std::visit([](const auto& bus) noexcept { return bus.state(); }, bus_);
  }
  BusCounts counts() const noexcept {
    return std::visit([](const auto& bus) noexcept { return bus.counts(); }, bus_);
  }
  void close() noexcept {
    std::visit([](auto& bus) noexcept { bus.close(); }, bus_);
  }

 private:
  std::variant<LoopbackBus, SocketCan> bus_;
  Frame ahead_{};       // taken off the bus by `wait`
  bool waits_ = false;  // to be received
};

static_assert(Bus<AnyBus>);

}  // namespace ebac::can
