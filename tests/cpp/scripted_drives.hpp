#pragma once

#include <array>
#include <cstdint>
#include <deque>

#include "ebac/can/bus.hpp"
#include "ebac/can/frame.hpp"
#include "ebac/canopen/cob_id.hpp"
#include "ebac/core/realtime.hpp"

/// The other side of a bus, with scripted answers: for behaviour that real drives never show.
namespace ebac::can {

/// One end: what the loop sent, and what waits for it.
struct ScriptedBus {
  std::deque<Frame> sent{};
  std::deque<Frame> waiting{};
  BusState now = BusState::kUp;
  bool full = false;
  std::uint32_t refused_id = 0xFFFFFFFF;  // of a frame that alone is not taken

  bool send(const Frame& frame) noexcept {
    const bool taken = !full && frame.id != refused_id;
    if (taken) sent.push_back(frame);
    return taken;
  }
  bool receive(Frame& frame) noexcept {
    if (waiting.empty()) return false;
    frame = waiting.front();
    waiting.pop_front();
    return true;
  }
  BusState state() const noexcept { return now; }
};

inline Frame answer(NodeId node, std::uint16_t statusword, std::int32_t position,
                    std::int16_t torque) {
  Frame made{.id = tpdo(1, node), .size = 8};
  put(made.data, 0, statusword);
  put(made.data, 2, position);
  put(made.data, 6, torque);
  return made;
}

/// Drives that follow the controlword at once and give the torque of the last SYNC.
struct ScriptedDrives {
  struct Drive {
    std::uint16_t statusword = 0x40;
    std::uint16_t controlword = 0;
    std::int16_t target = 0;
    std::int16_t actual = 0;
    std::int32_t position = 0;
    int offset = 0;      // of the torque, as 0x60B2
    int factor = 1;      // of the torque
    int copies = 1;      // of each answer
    bool stuck = false;  // stays in its state
  };

  ScriptedBus* bus = nullptr;
  int nodes = 1;
  std::array<Drive, 3> drive{};
  int syncs = 0;
  double elapsed = 0;  // s, in all

  void run(double seconds) noexcept {
    elapsed += seconds;
    for (; !bus->sent.empty(); bus->sent.pop_front()) take(bus->sent.front());
  }

  void take(const Frame& frame) {
    for (int i = 0; i < nodes; ++i) {
      Drive& one = drive[static_cast<std::size_t>(i)];
      const auto node = static_cast<NodeId>(i + 1);
      if (frame.id == rpdo(1, node)) {
        one.controlword = get<std::uint16_t>(frame.bytes(), 0);
        one.target = get<std::int16_t>(frame.bytes(), 2);
      } else if (frame.id == kSync) {
        if (!one.stuck) follow(one);
        for (int k = 0; k < one.copies; ++k) {
          bus->waiting.push_back(answer(node, one.statusword, one.position, one.actual));
        }
        const int torque = one.factor * one.target + one.offset;
        one.actual = static_cast<std::int16_t>(one.statusword == 0x27 ? torque : 0);
      }
    }
    syncs += frame.id == kSync ? 1 : 0;
  }

  static void follow(Drive& one) {
    switch (one.controlword) {
      case 0x06:
        one.statusword = 0x21;
        break;
      case 0x07:
        one.statusword = 0x23;
        break;
      case 0x0F:
        one.statusword = 0x27;
        break;
      case 0x02:
        one.statusword = 0x07;
        break;
      default:
        one.statusword = 0x40;
        break;
    }
  }
};

/// Lets the other side, which lives in the same thread, do its work once; afterwards every answer
/// has arrived. `run(elapsed)` receives the time since the last exchange [s].
template <class Other>
  requires requires(Other other, double elapsed) {
    { other.run(elapsed) } noexcept;
  }
class RunOther {
 public:
  explicit RunOther(Other& other) EBAC_RT : other_(&other) {}

  void begin(double elapsed) EBAC_RT {
    elapsed_ = elapsed;
    ran_ = false;
  }
  bool more() EBAC_RT {
    if (ran_) return false;
    other_->run(elapsed_);
    return ran_ = true;
  }

 private:
  Other* other_;
  double elapsed_ = 0;  // s
  bool ran_ = false;
};

}  // namespace ebac::can
