#pragma once

#include <concepts>
#include <cstdint>

#include "ebac/can/frame.hpp"

namespace ebac::can {

/// State of a bus. Every value is reported to the caller; none is an exception.
enum class BusState : std::uint8_t {
  kUp = 0,
  kWarning = 1,  // an error counter passed 96
  kPassive = 2,  // an error counter passed 127
  kBusOff = 3,   // the controller has left the bus
  kDown = 4,     // the interface is not up, or is gone
  kClosed = 5,   // never opened, or closed
};

/// Frame counts of one end of a bus since it was opened.
struct BusCounts {
  std::uint64_t sent = 0;
  std::uint64_t refused = 0;   // not taken by `send`
  std::uint64_t received = 0;  // taken by `receive`
  std::uint64_t lost = 0;      // arrived, but the receive queue was full
};

/// One end of a CAN bus. Neither call waits. `send` is false where the frame was refused (queue
/// full, bus not up), and the bus counts it; `receive` is false where nothing is waiting.
template <class B>
concept Bus = requires(B bus, const B& view, const Frame& out, Frame& in) {
  { bus.send(out) } noexcept -> std::same_as<bool>;
  { bus.receive(in) } noexcept -> std::same_as<bool>;
  { view.state() } noexcept -> std::same_as<BusState>;
};

}  // namespace ebac::can
