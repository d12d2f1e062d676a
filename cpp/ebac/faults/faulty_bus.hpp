#pragma once

#include <utility>

#include "ebac/canopen/cob_id.hpp"
#include "ebac/faults/injected_fault.hpp"
#include "ebac/faults/referee.hpp"
#include "ebac/simulated_drives/virtual_bus.hpp"

namespace ebac::faults {

/// The loop's end of a bus, on which frames are lost, late, doubled or damaged.
class FaultyBus {
 public:
  FaultyBus(can::VirtualBus& end, InjectedFault& injected, Referee& referee)
      : end_(&end), injected_(&injected), referee_(&referee) {}

  bool send(const can::Frame& frame) EBAC_RT {
    referee_->hear(frame);
    note(frame);
    if (injected_->on(Kind::kBusOff)) return false;
    const bool lost = (injected_->on(Kind::kLostCommand) && frame.id == can::rpdo(1, node())) ||
                      (injected_->on(Kind::kHeartbeatOfLoop) && frame.id > can::heartbeat(0));
    return lost || end_->send(frame);
  }

  bool receive(can::Frame& frame) EBAC_RT {
    if (injected_->on(Kind::kBusOff)) return false;
    if (has_held_ && held_at_ < injected_->tick) {
      frame = held_;
      has_held_ = false;
      return true;
    }
    if (has_twin_) {
      frame = twin_;
      has_twin_ = false;
      return true;
    }
    while (end_->receive(frame)) {
      if (arrives(frame)) return true;
    }
    return false;
  }

  can::BusState state() const EBAC_RT {
    if (injected_->on(Kind::kBusOff)) return can::BusState::kBusOff;
    return std::as_const(*end_).state();
  }

 private:
  can::NodeId node() const EBAC_RT { return static_cast<can::NodeId>(injected_->axis + 1); }

  /// Whether the loop sends a torque in this tick.
  void note(const can::Frame& frame) EBAC_RT {
    const bool torque = frame.id >= can::rpdo(1, 1) && frame.id <= can::rpdo(1, kMaxAxes);
    if (torque && can::get<std::int16_t>(frame.bytes(), 2) != 0) {
      injected_->last_command = injected_->tick;
    }
  }

  /// Whether the frame arrives; may alter it.
  bool arrives(can::Frame& frame) EBAC_RT {
    if (frame.id == can::heartbeat(node())) return !injected_->on(Kind::kHeartbeatOfNode);
    if (frame.id != can::tpdo(1, node())) return true;
    if (injected_->on(Kind::kLostAnswer)) return false;
    if (injected_->on(Kind::kLateAnswer)) {
      held_ = frame;
      held_at_ = injected_->tick;
      has_held_ = true;
      return false;
    }
    if (injected_->on(Kind::kDuplicateAnswer)) {
      twin_ = frame;
      has_twin_ = true;
    }
    if (injected_->on(Kind::kShortAnswer)) --frame.size;
    // Bits 8 to 30 of the position: a lower one may be a motion.
    if (injected_->on(Kind::kCorruptAnswer)) {
      const auto bit = 8 + injected_->chance % 23;
      frame.data[2 + bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    }
    return true;
  }

  can::VirtualBus* end_;
  InjectedFault* injected_;
  Referee* referee_;
  can::Frame held_{};
  can::Frame twin_{};
  std::int64_t held_at_ = 0;
  bool has_held_ = false;
  bool has_twin_ = false;
};

static_assert(can::Bus<FaultyBus>);

}  // namespace ebac::faults
