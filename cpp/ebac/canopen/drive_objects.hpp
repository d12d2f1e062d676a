#pragma once

#include "ebac/canopen/cia402.hpp"
#include "ebac/canopen/cob_id.hpp"
#include "ebac/canopen/object_table.hpp"

/// The one table of the simulated drive: its SDO server, its PDO mapping and its EDS read it.
namespace ebac::can {

inline constexpr std::size_t kPdos = 4;       // in each direction
inline constexpr std::size_t kMapped = 8;     // entries of one PDO
inline constexpr std::size_t kHistory = 8;    // errors kept in 0x1003
inline constexpr std::size_t kProducers = 4;  // heartbeats watched, 0x1016
inline constexpr std::size_t kTexts = 2;      // writable strings
inline constexpr std::size_t kTextRoom = 40;  // bytes of one

namespace detail {

using DriveTable = ObjectTable<288, 112>;

constexpr void add_communication(DriveTable& t) {
  t.var(0x1000, "Device type", Type::kU32, Access::kConst, 0x00020192);  // 402, servo drive
  t.var(0x1001, "Error register", Type::kU8, Access::kRo, 0, Mapping::kTpdo);
  t.var(0x1002, "Manufacturer status register", Type::kU32, Access::kRo, 0, Mapping::kTpdo);
  t.group(0x1003, "Pre-defined error field", Shape::kArray, 0, Access::kRw);
  constexpr std::array<std::string_view, kHistory> kErrors{
      "Error 1", "Error 2", "Error 3", "Error 4", "Error 5", "Error 6", "Error 7", "Error 8"};
  for (std::size_t i = 0; i < kHistory; ++i) {
    t.sub(static_cast<std::uint8_t>(i + 1), kErrors[i], Type::kU32, Access::kRo);
  }
  t.var(0x1005, "COB-ID SYNC message", Type::kU32, Access::kRw, 0x80);
  t.var(0x1006, "Communication cycle period", Type::kU32, Access::kRw);  // us
  t.var(0x1007, "Synchronous window length", Type::kU32, Access::kRw);   // us
  t.var(0x1008, "Manufacturer device name", Type::kString, Access::kConst).text =
      "ebac simulated drive";
  t.var(0x1009, "Manufacturer hardware version", Type::kString, Access::kConst).text = "none";
  t.var(0x100A, "Manufacturer software version", Type::kString, Access::kConst).text = "1";
  t.var(0x100C, "Guard time", Type::kU16, Access::kRw);       // ms
  t.var(0x100D, "Life time factor", Type::kU8, Access::kRw);  // guard times
  t.group(0x1010, "Store parameters", Shape::kArray, 1);
  t.sub(1, "Save all parameters", Type::kU32, Access::kRw, 1);
  t.group(0x1011, "Restore default parameters", Shape::kArray, 1);
  t.sub(1, "Restore all default parameters", Type::kU32, Access::kRw, 1);
  t.var(0x1014, "COB-ID EMCY", Type::kU32, Access::kRw, 0x80).plus_node = true;
  t.var(0x1015, "Inhibit time EMCY", Type::kU16, Access::kRw);  // 100 us
  t.group(0x1016, "Consumer heartbeat time", Shape::kArray, kProducers);
  constexpr std::array<std::string_view, kProducers> kNodes{
      "Consumer heartbeat time 1", "Consumer heartbeat time 2", "Consumer heartbeat time 3",
      "Consumer heartbeat time 4"};
  for (std::size_t i = 0; i < kProducers; ++i) {
    t.sub(static_cast<std::uint8_t>(i + 1), kNodes[i], Type::kU32, Access::kRw);
  }
  t.var(0x1017, "Producer heartbeat time", Type::kU16, Access::kRw);  // ms
  t.group(0x1018, "Identity object", Shape::kRecord, 4);
  t.sub(1, "Vendor-ID", Type::kU32, Access::kConst);                 // 0: not a product
  t.sub(2, "Product code", Type::kU32, Access::kConst, 0x65626163);  // "ebac"
  t.sub(3, "Revision number", Type::kU32, Access::kConst, 0x00010000);
  t.sub(4, "Serial number", Type::kU32, Access::kRo).plus_node = true;
  t.var(0x1019, "Synchronous counter overflow value", Type::kU8, Access::kRw).high = 240;
  t.group(0x1029, "Error behavior", Shape::kArray, 1);
  t.sub(1, "Communication error", Type::kU8, Access::kRw).high = 2;
  t.group(0x1200, "SDO server parameter", Shape::kRecord, 2);
  t.sub(1, "COB-ID client to server", Type::kU32, Access::kRo, 0x600).plus_node = true;
  t.sub(2, "COB-ID server to client", Type::kU32, Access::kRo, 0x580).plus_node = true;
}

constexpr std::int64_t map(std::uint16_t index, std::uint8_t sub, int bits) {
  return std::int64_t{index} << 16 | std::int64_t{sub} << 8 | bits;
}

constexpr void add_mapping(DriveTable& t, std::uint16_t index, std::string_view name,
                           std::int64_t first, std::int64_t second) {
  constexpr std::array<std::string_view, kMapped> kNames{
      "Mapping entry 1", "Mapping entry 2", "Mapping entry 3", "Mapping entry 4",
      "Mapping entry 5", "Mapping entry 6", "Mapping entry 7", "Mapping entry 8"};
  const int mapped = (first != 0 ? 1 : 0) + (second != 0 ? 1 : 0);
  t.group(index, name, Shape::kRecord, mapped, Access::kRw);
  for (std::size_t i = 0; i < kMapped; ++i) {
    const std::int64_t initial = i == 0 ? first : (i == 1 ? second : 0);
    t.sub(static_cast<std::uint8_t>(i + 1), kNames[i], Type::kU32, Access::kRw, initial);
  }
}

/// As CiA 402-2 wants a drive to come: PDO 1 carries controlword and statusword when they change,
/// the others are prepared and off.
constexpr void add_pdos(DriveTable& t) {
  constexpr std::array<std::array<std::string_view, kPdos>, 4> kNames{{
      {"RPDO 1 communication", "RPDO 2 communication", "RPDO 3 communication",
       "RPDO 4 communication"},
      {"RPDO 1 mapping", "RPDO 2 mapping", "RPDO 3 mapping", "RPDO 4 mapping"},
      {"TPDO 1 communication", "TPDO 2 communication", "TPDO 3 communication",
       "TPDO 4 communication"},
      {"TPDO 1 mapping", "TPDO 2 mapping", "TPDO 3 mapping", "TPDO 4 mapping"},
  }};
  constexpr std::array<std::int64_t, kPdos> kReceived{0, map(0x6060, 0, 8), map(0x6071, 0, 16), 0};
  constexpr std::array<std::int64_t, kPdos> kSent{0, map(0x6061, 0, 8), map(0x6064, 0, 32),
                                                  map(0x606C, 0, 32)};
  const auto on = [](std::size_t i) { return i == 0 ? 0 : kInvalid; };
  const auto at = [](std::size_t base, std::size_t i) {
    return static_cast<std::uint16_t>(base + i);
  };
  for (std::size_t i = 0; i < kPdos; ++i) {
    t.group(at(0x1400, i), kNames[0][i], Shape::kRecord, 5);
    t.sub(1, "COB-ID", Type::kU32, Access::kRw, on(i) + 0x200 + 0x100 * std::int64_t(i)).plus_node =
        true;
    t.sub(2, "Transmission type", Type::kU8, Access::kRw, 255);
    t.sub(5, "Event timer", Type::kU16, Access::kRw);  // ms, the longest silence
  }
  for (std::size_t i = 0; i < kPdos; ++i) {
    add_mapping(t, at(0x1600, i), kNames[1][i], map(0x6040, 0, 16), kReceived[i]);
  }
  for (std::size_t i = 0; i < kPdos; ++i) {
    t.group(at(0x1800, i), kNames[2][i], Shape::kRecord, 5);
    t.sub(1, "COB-ID", Type::kU32, Access::kRw, on(i) + kNoRemote + 0x180 + 0x100 * std::int64_t(i))
        .plus_node = true;
    t.sub(2, "Transmission type", Type::kU8, Access::kRw, 255);
    t.sub(3, "Inhibit time", Type::kU16, Access::kRw);  // 100 us
    t.sub(5, "Event timer", Type::kU16, Access::kRw);   // ms
  }
  for (std::size_t i = 0; i < kPdos; ++i) {
    add_mapping(t, at(0x1A00, i), kNames[3][i], map(0x6041, 0, 16), kSent[i]);
  }
}

constexpr void add_motor(DriveTable& t, std::uint16_t index, std::string_view name) {
  t.group(index, name, Shape::kRecord, 23);
  t.sub(12, "Torque constant", Type::kU32, Access::kRw).low = 1;    // 1e-5 N m/A
  t.sub(13, "Peak torque", Type::kU32, Access::kRw).low = 1;        // 1e-5 N m
  t.sub(14, "Continuous torque", Type::kU32, Access::kRw).low = 1;  // 1e-5 N m
  t.sub(23, "Counts per turn", Type::kU32, Access::kRw).low = 1;
}

/// Copley's. Their meaning is confirmed for 0x2183 bit 0x400, 0x2300 and 0x2383; 0x2112 and 0x2182
/// are from memory, indicative.
constexpr void add_manufacturer(DriveTable& t) {
  t.var(0x2112, "Peak current time", Type::kU16, Access::kRw);  // ms
  t.var(0x2182, "Fault mask", Type::kU32, Access::kRw);         // latched faults that stop
  t.var(0x2183, "Latched faults", Type::kU32, Access::kRw);     // a 1 written clears the bit
  t.var(0x2300, "Desired state", Type::kU16, Access::kRw, 30);  // 30: CANopen servo
  add_motor(t, 0x2383, "Motor data");
  t.var(0x5F00, "Simulated conditions", Type::kU8, Access::kWo);          // see Condition
  t.var(0x5F01, "Simulated inputs", Type::kU8, Access::kWo).high = 0x03;  // its upper bits
}

constexpr void add_profile(DriveTable& t) {
  using M = Mapping;
  Entry& abort = t.var(0x6007, "Abort connection option code", Type::kI16, Access::kRw, 1);
  abort.low = 0;
  abort.high = 3;
  t.var(0x603F, "Error code", Type::kU16, Access::kRo, 0, M::kTpdo);
  t.var(0x6040, "Controlword", Type::kU16, Access::kRw, 0, M::kBoth);
  t.var(0x6041, "Statusword", Type::kU16, Access::kRo, 0, M::kTpdo);
  t.var(0x605A, "Quick stop option code", Type::kI16, Access::kRw, 2);
  t.var(0x605B, "Shutdown option code", Type::kI16, Access::kRw);
  t.var(0x605C, "Disable operation option code", Type::kI16, Access::kRw);
  t.var(0x605D, "Halt option code", Type::kI16, Access::kRw, 1);
  t.var(0x605E, "Fault reaction option code", Type::kI16, Access::kRw, 2);
  t.var(0x6060, "Modes of operation", Type::kI8, Access::kRw, kNoMode, M::kBoth);
  t.var(0x6061, "Modes of operation display", Type::kI8, Access::kRo, 0, M::kTpdo);
  t.var(0x6064, "Position actual value", Type::kI32, Access::kRo, 0, M::kTpdo);  // counts
  t.var(0x606C, "Velocity actual value", Type::kI32, Access::kRo, 0, M::kTpdo);  // 0.1 counts/s
  t.var(0x6071, "Target torque", Type::kI16, Access::kRw, 0, M::kBoth);
  t.var(0x6072, "Max torque", Type::kU16, Access::kRw, 1000, M::kBoth);
  t.var(0x6073, "Max current", Type::kU16, Access::kRw, 1000, M::kBoth);
  t.var(0x6074, "Torque demand value", Type::kI16, Access::kRo, 0, M::kTpdo);
  t.var(0x6075, "Motor rated current", Type::kU32, Access::kRo);  // mA, from the motor data
  t.var(0x6076, "Motor rated torque", Type::kU32, Access::kRo);   // mN m, likewise
  t.var(0x6077, "Torque actual value", Type::kI16, Access::kRo, 0, M::kTpdo);
  t.var(0x6078, "Current actual value", Type::kI16, Access::kRo, 0, M::kTpdo);
  // In torque modes it is torque that a quick stop takes off: permille/s, by default all at once.
  t.var(0x6085, "Quick stop deceleration", Type::kU32, Access::kRw, 0xFFFFFFFF, M::kBoth);
  t.var(0x6087, "Torque slope", Type::kU32, Access::kRw, 1000, M::kBoth);  // permille/s
  t.var(0x60B2, "Torque offset", Type::kI16, Access::kRw, 0, M::kBoth);
  t.var(0x60FD, "Digital inputs", Type::kU32, Access::kRo, 0, M::kTpdo);  // see Input
  t.group(0x60FE, "Digital outputs", Shape::kArray, 1);
  t.sub(1, "Physical outputs", Type::kU32, Access::kRo, 1);  // bit 0: the brake holds
  t.var(0x6403, "Motor catalogue number", Type::kString, Access::kRw, 0);
  t.var(0x6404, "Motor manufacturer", Type::kString, Access::kRw, 1);
  add_motor(t, 0x6410, "Motor data, former index");  // the same values as 0x2383
  t.var(0x6502, "Supported drive modes", Type::kU32, Access::kConst, kSupportedModes);
}

constexpr DriveTable drive_table() {
  DriveTable t;
  add_communication(t);
  add_pdos(t);
  add_manufacturer(t);
  add_profile(t);
  return t;
}

}  // namespace detail

inline constexpr auto kDriveTable = detail::drive_table();

/// The slot of an entry, known at compile time.
template <std::uint16_t Index, std::uint8_t Sub = 0>
  requires(kDriveTable.slot(Index, Sub) != kNoSlot)
inline constexpr std::size_t kAt = kDriveTable.slot(Index, Sub);

}  // namespace ebac::can
