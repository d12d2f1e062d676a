#pragma once

#include <concepts>

#include "ebac/can/bus.hpp"

namespace ebac::can {

/// What takes frames and leaves frames: a drive, or a joystick of them.
template <class N>
concept Node = requires(N node, const Frame& in, Frame& out) {
  { node.receive(in) } noexcept;
  { node.take(out) } noexcept -> std::same_as<bool>;
};

/// Carries what waits on the bus to the node, and what the node says to the bus. Waits for nothing;
/// a frame the bus refuses is lost, and the bus counts it.
template <Bus B, Node N>
void serve(B& bus, N& node) EBAC_RT {
  Frame frame;
  const auto answer = [&]() EBAC_RT {
    Frame out;
    while (node.take(out)) static_cast<void>(bus.send(out));
  };
  answer();
  while (bus.receive(frame)) {
    node.receive(frame);
    answer();
  }
}

}  // namespace ebac::can
