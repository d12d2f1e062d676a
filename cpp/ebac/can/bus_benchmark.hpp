#pragma once

#include <chrono>
#include <cstdint>
#include <thread>

#include "ebac/can/loopback_bus.hpp"
#include "ebac/core/best_time.hpp"

/// How long a frame takes from end to end of a loopback bus, without Python inside [ns].
namespace ebac::can {

/// Sent and received by one thread, one after the other.
inline double time_one_thread(std::uint32_t frames, int repeats) {
  LoopbackHub hub(LoopbackHub::Stamps::kWallClock);
  LoopbackBus from = hub.open();
  LoopbackBus to = hub.open();
  const Frame out = frame(0x181, {0x37, 0x02, 0, 0, 0, 0, 0, 0});
  return best_nanoseconds(repeats, frames, [&] {
    Frame in;
    for (std::uint32_t i = 0; i < frames; ++i) {
      from.send(out);
      to.receive(in);
    }
  });
}

/// Sent by one thread as quickly as it can, received by another that waits for them.
inline double time_two_threads(std::uint32_t frames, int repeats) {
  LoopbackHub hub(LoopbackHub::Stamps::kWallClock);
  LoopbackBus from = hub.open();
  LoopbackBus to = hub.open({.frames = frames});
  return best_nanoseconds(repeats, frames, [&] {
    std::thread sender([&] {
      for (std::uint32_t i = 0; i < frames;) i += from.send(frame(0x181, {})) ? 1 : 0;
    });
    Frame in;
    for (std::uint32_t i = 0; i < frames && to.receive(in, std::chrono::seconds{10});) ++i;
    sender.join();
  });
}

}  // namespace ebac::can
