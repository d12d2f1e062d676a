#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "ebac/canopen/canopen_setup.hpp"
#include "ebac/canopen/loop_watch.hpp"
#include "ebac/canopen/torque.hpp"
#include "ebac/model/device.hpp"
#include "ebac/simulated_drives/simulated_drive.hpp"
#include "ebac/simulated_drives/timed_bus.hpp"
#include "ebac/simulated_drives/virtual_bus.hpp"

namespace ebac::can {

/// How the drives of a test bench and its loop watch each other; 0 for not at all.
struct Watches {
  std::int64_t drive_heartbeat = 0;  // ms, between two of a drive
  std::int64_t loop_silence = 0;     // ms, without the loop's heartbeat
  std::int64_t torque_silence = 0;   // ms, without a torque
};

/// Node under which a watched loop sends its heartbeat.
inline constexpr int kLoopNode = 100;

/// The watches of a bus that takes time.
inline Watches watches_of(const TimedBus& bus) {
  const auto ms = [](double seconds) {  // 0 would be none
    return seconds > 0 ? std::max(1LL, std::llround(1e3 * seconds)) : 0LL;
  };
  return {.drive_heartbeat = ms(bus.drive_heartbeat),
          .loop_silence = ms(bus.loop_silence),
          .torque_silence = ms(bus.torque_silence)};
}

/// The loop's side of its drives, with the watches of a bus that takes time.
inline CanopenSetup can_setup(const DeviceModel& device, const std::optional<TimedBus>& bus) {
  CanopenSetup setup{.axes = device.axes(), .motor = device.motor, .drive = device.drive};
  if (!bus) return setup;
  setup.silent_ticks = bus->silent_ticks;
  setup.heartbeat_timeout = 3 * (static_cast<double>(watches_of(*bus).drive_heartbeat) / 1e3);
  if (bus->loop_silence > 0) {
    setup.own_node = kLoopNode;
    setup.heartbeat_period = beat_period(bus->loop_silence);
  }
  return setup;
}

inline WireOptions wire_of(const TimedBus& bus, int axes) {
  return {.stations = VirtualBus::kFirstDrive + static_cast<std::size_t>(axes),
          .bit_rate = bus.bit_rate,
          .error_rate = bus.error_rate,
          .seed = static_cast<std::uint64_t>(bus.seed)};
}

/// Lets a drive follow a torque of at most `most` thousandths at every SYNC, and watch the loop.
inline void set_up(SimulatedDrive& drive, int most, const Watches& watches = {}) {
  const auto write = [&](std::uint16_t index, std::uint8_t sub, std::int64_t value) {
    if (drive.write(index, sub, value) != Abort{}) {
      throw std::logic_error("a simulated drive refused object " + std::to_string(index) + ":" +
                             std::to_string(sub));
    }
  };
  if (watches.drive_heartbeat > 0) write(0x1017, 0, watches.drive_heartbeat);
  if (watches.loop_silence > 0) {
    write(0x1016, 1, std::int64_t{kLoopNode} << 16 | watches.loop_silence);
  }
  if (watches.torque_silence > 0) write(0x1400, 5, watches.torque_silence);
  for (const ObjectWrite& one : torque_settings(drive.node(), most)) {
    write(one.index, one.sub, one.value);
  }
}

}  // namespace ebac::can
