#pragma once

#include <cstdint>
#include <vector>

#include "ebac/core/best_time.hpp"
#include "ebac/simulated_drives/through_can.hpp"

/// Time of an exchange on the bus, without Python inside [ns].
namespace ebac::can {

/// A plant that rests, so that the bus and its two sides are all there is to time.
struct RestingPlant {
  static Reading exchange(const Command& command) EBAC_RT {
    return {.current_applied = command.current};
  }
};

/// A bus whose drives answer at once with prepared frames, one node after the other.
class AnsweringBus {
 public:
  explicit AnsweringBus(int nodes) {
    for (int i = 0; i < nodes; ++i) {
      answers_.push_back({.id = tpdo(1, static_cast<NodeId>(i + 1)), .size = kTpdoSize});
      put(answers_.back().data, 0, status_bits(DriveState::kOperationEnabled));
    }
    next_ = answers_.size();
  }

  bool send(const Frame& frame) EBAC_RT {
    if (frame.id == kSync) next_ = 0;
    return true;
  }
  bool receive(Frame& frame) EBAC_RT {
    if (next_ == answers_.size()) return false;
    frame = answers_[next_++];
    return true;
  }
  BusState state() const EBAC_RT { return BusState::kUp; }

 private:
  std::vector<Frame> answers_;
  std::size_t next_ = 0;
};

struct NoWait {
  void begin(double) EBAC_RT {}
  bool more() EBAC_RT { return false; }
};

template <Device D>
double time_exchanges(D& device, int ticks, int repeats) {
  [[maybe_unused]] volatile std::int64_t sink = 0;  // so that the work is not optimised away
  return best_nanoseconds(repeats, static_cast<std::size_t>(ticks), [&] {
    std::int64_t sum = 0;
    for (int k = 0; k < ticks; ++k) {
      const double current = 0.01 * (k % 100);  // A
      sum += device.exchange({.current = {current, -current}, .elapsed = 1e-3}).counts[0];
    }
    sink = sum;
  });
}

/// `exchange` over a bus in one thread with two simulated drives at its other end.
inline double time_exchange(int ticks, int repeats) {
  DeviceModel model;
  model.kinematics = Linear{.axes = 2};
  ThroughCan<RestingPlant> device({}, model, Timing{});
  device.switch_on();
  return time_exchanges(device, ticks, repeats);
}

/// The loop's side of it alone: two drives that answer from memory.
inline double time_own_exchange(int ticks, int repeats) {
  AnsweringBus bus(2);
  CanopenDevice<AnsweringBus, NoWait> device(bus, {}, {.axes = 2});
  device.enable();
  return time_exchanges(device, ticks, repeats);
}

}  // namespace ebac::can
