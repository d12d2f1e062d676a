#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "ebac/model/device.hpp"
#include "ebac/simulated_drives/joystick.hpp"
#include "ebac/simulated_drives/virtual_bus.hpp"

namespace ebac::can {

/// A plant whose reading stays the same as long as no time passes, however often it is read: a SYNC
/// before the start then draws no noise. Time can be held.
template <Device D>
class Still {
 public:
  explicit Still(D plant) : plant_(std::move(plant)) {}

  Reading exchange(const Command& command) EBAC_RT {
    if (!read_ || (command.elapsed > 0 && !held_)) reading_ = plant_.exchange(command);
    read_ = true;
    return reading_;
  }
  void hold(bool on) EBAC_RT { held_ = on; }
  /// From now on its hand wants to be at `target` [m].
  void aim(std::size_t axis, double target) EBAC_RT
    requires requires(D& d) { d.aim(axis, target); }
  {
    plant_.aim(axis, target);
  }
  const D& plant() const EBAC_RT { return plant_; }

 private:
  D plant_;
  Reading reading_{};
  bool read_ = false;
  bool held_ = false;
};

/// Times of a loop whose bus takes its own.
struct LoopTimes {
  double dt = 1e-3;        // s, sample time
  double answer = 0.5e-3;  // s, for which it waits for answers
  double response = 0;     // s, from a frame to a drive's answer
};

/// A plant with simulated drives on the other side of a bus; also the loop's `Wait`, by reference.
///
/// Without a wire the drives work once per exchange, and every answer has arrived. With one they
/// work as frames arrive, and the loop waits in virtual time. An exchange without elapsed time takes
/// a tick of the bus, for which the plant stands still.
template <Device D>
class JoystickOnBus {
 public:
  JoystickOnBus(D plant, const DeviceModel& device, VirtualBus& bus, const LoopTimes& times = {},
                const Wiring& wiring = {})
      : joystick_(Still<D>(std::move(plant)), device, wiring, kPeakTime),
        bus_(&bus),
        times_(times) {}

  /// The loop begins an exchange, `elapsed` s after the last one.
  void begin(double elapsed) EBAC_RT {
    elapsed_ = elapsed;
    ran_ = false;
    if (!bus_->timed()) return;
    joystick_.plant().hold(elapsed == 0);
    // A loop that has waited for answers beyond its next tick begins that one late.
    begun_ = std::max(begun_ + nanoseconds(elapsed == 0 ? times_.dt : elapsed), bus_->now());
    while (step(begun_)) {
    }
  }
  /// Whether more frames may have arrived for the loop.
  bool more() EBAC_RT {
    if (!bus_->timed()) return !std::exchange(ran_, true) && run();
    const std::int64_t end = begun_ + nanoseconds(times_.answer);
    while (bus_->now() < end && step(end)) {
      if (bus_->loop_has_frames()) return true;
    }
    return false;
  }

  /// From now on the drives take `seconds` to answer.
  void respond_after(double seconds) EBAC_RT { times_.response = seconds; }

  const D& plant() const EBAC_RT { return joystick_.plant().plant(); }
  Joystick<Still<D>>& joystick() EBAC_RT { return joystick_; }
  const Joystick<Still<D>>& joystick() const EBAC_RT { return joystick_; }

 private:
  static constexpr double kPeakTime = 65.535;  // s, the longest: a motor that hardly warms

  static std::int64_t nanoseconds(double seconds) EBAC_RT { return std::llround(seconds * 1e9); }

  /// Advances time, receives the waiting frames and sends the answers.
  bool run() EBAC_RT {
    joystick_.elapse(elapsed_);
    hear();
    speak(0);
    return true;
  }

  /// Goes on to the next frame that arrives anywhere, or to `until`: then false.
  bool step(std::int64_t until) EBAC_RT {
    const std::int64_t before = bus_->now();
    const bool came = bus_->advance(until);
    joystick_.elapse(1e-9 * static_cast<double>(bus_->now() - before));
    speak(bus_->now());
    hear();
    speak(bus_->now() + nanoseconds(times_.response));
    const SimulatedWire* wire = bus_->wire();
    for (std::size_t i = 0; wire != nullptr && i < joystick_.axes(); ++i) {
      // Off the bus, a drive neither hears nor speaks.
      joystick_.drive(i).set_condition(Condition::kSilent, wire->off(VirtualBus::kFirstDrive + i));
    }
    return came;
  }

  void hear() EBAC_RT {
    Frame frame;
    while (bus_->take(frame)) joystick_.receive(frame);
  }
  void speak(std::int64_t due) EBAC_RT {
    Frame frame;
    for (std::size_t i = 0; i < joystick_.axes(); ++i) {
      while (joystick_.drive(i).take(frame)) {
        bus_->send_as(VirtualBus::kFirstDrive + i, frame, due);
      }
    }
  }

  Joystick<Still<D>> joystick_;
  VirtualBus* bus_;
  LoopTimes times_;
  double elapsed_ = 0;      // s
  bool ran_ = false;        // in this exchange
  std::int64_t begun_ = 0;  // ns, this exchange
};

/// The loop's `Wait`: on the other side of its bus, by reference.
template <class Other>
class OnOtherSide {
 public:
  explicit OnOtherSide(Other& other) EBAC_RT : other_(&other) {}

  void begin(double elapsed) EBAC_RT { other_->begin(elapsed); }
  bool more() EBAC_RT { return other_->more(); }

 private:
  Other* other_;
};

}  // namespace ebac::can
