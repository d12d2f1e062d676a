#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ebac/canopen/cob_id.hpp"

/// The process data of one device and their share of the bus, computed before the loop starts.
namespace ebac::can {

/// RPDO 1 of a drive: controlword 0x6040 u16, target torque 0x6071 i16.
inline constexpr int kRpdoSize = 4;  // bytes
/// TPDO 1 of a drive: statusword 0x6041 u16, position 0x6064 i32, actual torque 0x6077 i16.
inline constexpr int kTpdoSize = 8;  // bytes

/// One kind of frame that is sent in every period.
struct PlannedFrame {
  std::string what;
  std::uint32_t id = 0;
  int size = 0;   // bytes of data
  int count = 1;  // frames per period
};

/// The fewest bits a frame with an 11-bit identifier takes: 8 n of data, 44 of frame, 3 between
/// frames.
constexpr int least_bits(int size) EBAC_RT { return 8 * size + 47; }

/// The most bits: those, and a stuff bit after every fourth of the 34 + 8 n that can be stuffed.
constexpr int worst_bits(int size) EBAC_RT { return least_bits(size) + (34 + 8 * size - 1) / 4; }

/// SYNC, and for every node one RPDO and one TPDO. Throws std::invalid_argument for a node out of
/// [1, 127] or one given twice.
std::vector<PlannedFrame> pdo_plan(std::span<const int> nodes);

/// Bus load of a plan.
struct BusLoad {
  std::vector<PlannedFrame> frames;
  double bit_rate = 1e6;  // bit/s
  double period = 1e-3;   // s

  std::int64_t bits(const PlannedFrame& frame) const {
    return std::int64_t{frame.count} * worst_bits(frame.size);
  }
  double seconds(const PlannedFrame& frame) const {
    return static_cast<double>(bits(frame)) / bit_rate;
  }
  double share(const PlannedFrame& frame) const { return seconds(frame) / period; }
  std::int64_t bits() const;
  double seconds() const {  // s, of every period, at the worst
    return static_cast<double>(bits()) / bit_rate;
  }
  double share() const { return seconds() / period; }  // of the bus
  double highest_rate() const;                         // Hz, at which the plan would still fit
};

inline constexpr double kWarnedLoad = 0.7;
inline constexpr double kRefusedLoad = 0.9;

/// Empty up to 70 % of the bus; up to 90 % a warning with numbers and remedy. Throws
/// std::invalid_argument over that, and for a bit rate or a period that no CAN bus has.
std::string check_load(const BusLoad& load);

}  // namespace ebac::can
