#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <thread>

#include "ebac/can/loopback_bus.hpp"

/// How long a frame takes from end to end of a loopback bus, without Python inside. The best of
/// several runs, since noise only adds.
namespace ebac::can {

template <class Work>
double nanoseconds_per_frame(int repeats, std::uint32_t frames, Work work) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
    best = std::min(best, taken.count() / frames);
  }
  return best;
}

/// Sent and received by one thread, one after the other.
inline double time_one_thread(std::uint32_t frames, int repeats) {
  LoopbackHub hub(LoopbackHub::Stamps::kWallClock);
  LoopbackBus from = hub.open();
  LoopbackBus to = hub.open();
  const Frame out = frame(0x181, {0x37, 0x02, 0, 0, 0, 0, 0, 0});
  return nanoseconds_per_frame(repeats, frames, [&] {
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
  return nanoseconds_per_frame(repeats, frames, [&] {
    std::thread sender([&] {
      for (std::uint32_t i = 0; i < frames;) i += from.send(frame(0x181, {})) ? 1 : 0;
    });
    Frame in;
    for (std::uint32_t i = 0; i < frames && to.receive(in, std::chrono::seconds{10});) ++i;
    sender.join();
  });
}

}  // namespace ebac::can
