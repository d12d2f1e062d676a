#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ebac/canopen/cob_id.hpp"

/// The frames of one device and their share of the bus, computed before the loop starts.
namespace ebac::can {

/// RPDO 1 of a drive: controlword 0x6040 u16, target torque 0x6071 i16.
inline constexpr int kRpdoSize = 4;  // bytes
/// TPDO 1 of a drive: statusword 0x6041 u16, position 0x6064 i32, actual torque 0x6077 i16.
inline constexpr int kTpdoSize = 8;       // bytes
inline constexpr int kHeartbeatSize = 1;  // bytes

/// One kind of frame that is sent in every period, or after a time of its own.
struct PlannedFrame {
  std::string what;
  std::uint32_t id = 0;
  int size = 0;      // bytes of data
  int count = 1;     // frames per period
  double every = 0;  // s, between two such counts; 0 for the period
};

/// The fewest bits a frame with an 11-bit identifier takes: 8 n of data, 44 of frame, 3 between
/// frames.
constexpr int least_bits(int size) EBAC_RT { return 8 * size + 47; }

/// The most bits: those, and a stuff bit after every fourth of the 34 + 8 n that can be stuffed.
constexpr int worst_bits(int size) EBAC_RT { return least_bits(size) + (34 + 8 * size - 1) / 4; }

/// SYNC, and for every node one RPDO and one TPDO. Throws std::invalid_argument for a node out of
/// [1, 127] or one given twice.
std::vector<PlannedFrame> pdo_plan(std::span<const int> nodes);

/// Heartbeats: of every node each `every` [s], and of the loop, as node `loop`, each `loop_every` [s]; 0 sends none. Throws
/// as `pdo_plan`.
std::vector<PlannedFrame> heartbeat_plan(std::span<const int> nodes, double every, int loop,
                                         double loop_every);

/// Bus load of a plan. It has no SDO, which the loop does not use while it runs, and no emergency, which ends the run.
struct BusLoad {
  std::vector<PlannedFrame> frames;
  double bit_rate = 1e6;  // bit/s
  double period = 1e-3;   // s

  /// Of one kind of frame in a period in which it comes.
  std::int64_t bits(const PlannedFrame& frame) const;
  double seconds(const PlannedFrame& frame) const {
    return static_cast<double>(bits(frame)) / bit_rate;
  }
  double share(const PlannedFrame& frame) const;
  /// Of the worst period, in which all of them come.
  std::int64_t bits() const;
  double seconds() const { return static_cast<double>(bits()) / bit_rate; }  // s
  double share() const;         // of the bus, on average
  double highest_rate() const;  // Hz, at which the plan would still fit; 0 for none
};

inline constexpr double kWarnedLoad = 0.7;
inline constexpr double kRefusedLoad = 0.9;

/// Empty up to 70 % of the bus; up to 90 % a warning with numbers and remedy. Throws
/// std::invalid_argument over that, and for a bit rate or a period that no CAN bus has.
std::string check_load(const BusLoad& load);

}  // namespace ebac::can
