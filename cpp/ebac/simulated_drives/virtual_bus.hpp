#pragma once

#include <optional>
#include <utility>

#include "ebac/can/bus.hpp"
#include "ebac/can/frame_queue.hpp"
#include "ebac/simulated_drives/simulated_wire.hpp"

namespace ebac::can {

/// The bus of a test bench, in one thread and in virtual time: between a loop, whose end this is,
/// and the drives. Over a wire frames take their time; without one each arrives at once.
class VirtualBus {
 public:
  /// Stations of the wire: the loop, any other node, and from the third on one for each drive.
  static constexpr std::size_t kLoop = 0;
  static constexpr std::size_t kOther = 1;
  static constexpr std::size_t kFirstDrive = 2;

  VirtualBus() = default;
  /// The loop's controller stays off the bus once it is: an interface of Linux is restarted by hand.
  explicit VirtualBus(SimulatedWire wire) {
    wire.set_recovers(kLoop, false);
    wire_ = std::move(wire);
  }

  // The loop's end.
  bool send(const Frame& frame) EBAC_RT { return send_as(kLoop, frame, now_); }
  bool receive(Frame& frame) EBAC_RT { return to_loop_.pop(frame); }
  BusState state() const EBAC_RT { return wire_ ? wire_->state(kLoop) : BusState::kUp; }

  /// A frame of `station` that may go from `due` [ns] on; without a wire it has arrived.
  bool send_as(std::size_t station, const Frame& frame, std::int64_t due) EBAC_RT {
    if (wire_) return wire_->send(station, frame, due);
    return sendable(frame) && arrive(station, frame);
  }

  /// The next frame for the drives.
  bool take(Frame& frame) EBAC_RT { return to_drives_.pop(frame); }

  /// Time goes on to the next frame that arrives, or to `until` [ns]: then false.
  bool advance(std::int64_t until) EBAC_RT {
    SimulatedWire::Delivery came;
    if (!wire_ || !wire_->next(until, came)) {
      now_ = until;
      return false;
    }
    now_ = came.frame.stamp;
    came.frame.stamp = 0;
    arrive(came.from, came.frame);
    return true;
  }
  std::int64_t now() const EBAC_RT { return now_; }  // ns
  bool loop_has_frames() const EBAC_RT { return to_loop_.front() != nullptr; }

  bool timed() const EBAC_RT { return wire_.has_value(); }
  /// nullptr where there is none.
  SimulatedWire* wire() EBAC_RT { return wire_ ? &*wire_ : nullptr; }
  const SimulatedWire* wire() const EBAC_RT { return wire_ ? &*wire_ : nullptr; }

 private:
  bool arrive(std::size_t from, const Frame& frame) EBAC_RT {
    const bool for_drives = from >= kFirstDrive || to_drives_.push(frame);
    // A controller that is off the bus hears nothing.
    const bool deaf = from == kLoop || state() == BusState::kBusOff;
    return deaf ? for_drives : to_loop_.push(frame) && for_drives;
  }

  std::optional<SimulatedWire> wire_;
  FrameQueue<1024> to_loop_;
  FrameQueue<256> to_drives_;
  std::int64_t now_ = 0;  // ns, of the wire
};

static_assert(Bus<VirtualBus>);

}  // namespace ebac::can
