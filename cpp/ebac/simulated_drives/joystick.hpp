#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <utility>

#include "ebac/core/device.hpp"
#include "ebac/model/device.hpp"
#include "ebac/simulated_drives/simulated_drive.hpp"
#include "ebac/simulated_drives/wiring.hpp"

namespace ebac::can {

/// Drives on the axes of one plant, connected as `wiring` has it: by default node 1 moves axis 0, node 2 axis 1.
///
/// On SYNC the plant advances by the time since the last one, under the currents set then; its
/// counts are latched and sent; then the data received before the SYNC take effect. A loop that
/// sends its currents and SYNC in one exchange thus sees a delay of one tick. A current that
/// changes between two SYNCs (asynchronous RPDO, SDO, ramp, fault) acts from that moment on.
/// Without a SYNC for a while, the plant follows the elapsed time. With `wait_for_power` its time
/// begins when a drive is first enabled: until then neither plant nor hand moves.
///
/// `D` applies each current as given: a simulated device must have no delay, and torque in whole
/// thousandths.
template <Device D>
  requires std::copyable<D>
class Joystick {
 public:
  Joystick(D plant, const DeviceModel& device, const Wiring& wiring = {}, double peak_time = 2,
           bool wait_for_power = false)
      : plant_(std::move(plant)),
        axes_(static_cast<std::size_t>(device.axes())),
        waits_(wait_for_power),
        wiring_(wiring) {
    for (std::size_t i = 0; i < axes_; ++i) {
      drive_[i] = SimulatedDrive({.node = wiring.node[i],
                                  .motor = device.motor,
                                  .drive = device.drive,
                                  .counts_per_turn = device.encoder.counts_per_turn,
                                  .peak_time = peak_time,
                                  .sheet = wiring.sheet[i]});
    }
    wiring_.sheet = {};  // its entries need not outlive this
    D peek = plant_;     // the first reading must not change the plant
    show(peek.exchange({}));
  }

  void receive(const Frame& frame) EBAC_RT {
    bool sync = false;
    for (std::size_t i = 0; i < axes_; ++i) sync = sync || drive_[i].is_sync(frame);
    if (sync) {
      move(std::exchange(since_, 0.0));
      silence_ = 0;
    }
    for (std::size_t i = 0; i < axes_; ++i) drive_[i].receive(frame);
    hold();
  }

  /// Lets `seconds` pass.
  void elapse(double seconds) EBAC_RT {
    hold();  // values written to a drive directly
    since_ += seconds;
    silence_ += seconds;
    if (silence_ > kPatience && since_ > 0) {
      while (since_ > kStep) {
        move(kStep);
        since_ -= kStep;
      }
      move(std::exchange(since_, 0.0));
    }
    rest_ += seconds * 1e9;
    const auto whole = static_cast<std::int64_t>(rest_);
    rest_ -= static_cast<double>(whole);
    for (std::size_t i = 0; i < axes_; ++i) drive_[i].elapse(whole);
    hold();
  }

  /// The next frame of any drive; false where none is.
  bool take(Frame& frame) EBAC_RT {
    for (std::size_t i = 0; i < axes_; ++i) {
      if (drive_[i].take(frame)) return true;
    }
    return false;
  }

  std::size_t axes() const EBAC_RT { return axes_; }
  SimulatedDrive& drive(std::size_t axis) EBAC_RT { return drive_[axis]; }
  const SimulatedDrive& drive(std::size_t axis) const EBAC_RT { return drive_[axis]; }
  /// Whether no drive has power: by itself, not by what a loop hears of it.
  bool off() const EBAC_RT {
    for (std::size_t i = 0; i < axes_; ++i) {
      if (drive_[i].motor_on() || drive_[i].current() != 0) return false;
    }
    return true;
  }
  const D& plant() const EBAC_RT { return plant_; }
  D& plant() EBAC_RT { return plant_; }
  /// The last reading of the plant, with values that no drive sends, such as the force.
  const Reading& reading() const EBAC_RT { return reading_; }

 private:
  static constexpr double kPatience = 0.2;  // s, longer than any sample time
  static constexpr double kStep = 0.01;     // s

  /// Moves the plant under the currents that act, and shows its counts to the drives.
  void move(double seconds) EBAC_RT {
    if (waits_ && !powered()) return;
    waits_ = false;
    show(plant_.exchange({.current = current_, .elapsed = seconds}));
  }
  bool powered() const EBAC_RT {
    for (std::size_t i = 0; i < axes_; ++i) {
      if (drive_[i].state() == DriveState::kOperationEnabled) return true;
    }
    return false;
  }
  void show(const Reading& reading) EBAC_RT {
    reading_ = reading;
    for (std::size_t i = 0; i < axes_; ++i) {
      if (reading_.fault != Fault::kNone) drive_[i].set_condition(Condition::kEncoderLost, true);
      drive_[i].set_position(wiring_.encoder[i] * reading_.counts[i] + wiring_.zero[i]);
    }
  }

  /// Where a current has changed, the time until now still belongs to the old ones.
  void hold() EBAC_RT {
    std::array<double, kMaxAxes> now{};
    for (std::size_t i = 0; i < axes_; ++i) now[i] = wiring_.motor[i] * drive_[i].current();
    if (now == current_) return;
    if (since_ > 0) move(std::exchange(since_, 0.0));
    current_ = now;
  }

  D plant_;
  std::array<SimulatedDrive, kMaxAxes> drive_{};
  std::size_t axes_;
  bool waits_;  // until a drive is enabled
  Wiring wiring_;
  std::array<double, kMaxAxes> current_{};  // A, acting since the plant last moved
  double since_ = 0;                        // s, since the plant last moved
  double silence_ = 2 * kPatience;          // s, since the last SYNC
  double rest_ = 0;                         // ns, less than one, not yet passed to the drives
  Reading reading_;
};

}  // namespace ebac::can
