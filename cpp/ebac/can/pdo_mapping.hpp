#pragma once

#include "ebac/can/object_dictionary.hpp"

namespace ebac::can {

enum class Direction : std::uint8_t { kReceive, kTransmit };

inline constexpr std::uint16_t kDummy = 0xFFFF;  // bytes that are received and dropped

/// What one PDO carries, ready for use.
struct PdoMap {
  std::array<std::uint16_t, kMapped> slot{};  // or kDummy
  std::array<std::uint8_t, kMapped> size{};   // bytes
  std::uint8_t count = 0;                     // entries
  std::uint8_t bytes = 0;
};

/// Whether `index` belongs to a PDO: 0x1400, 0x1600, 0x1800, 0x1A00 and what follows.
constexpr bool is_pdo(std::uint16_t index) EBAC_RT { return index >= 0x1400 && index < 0x1C00; }

/// What stands in the way of writing `value` to a PDO parameter (CiA 301, 7.5.2.33 to 38): the
/// mapping of a valid PDO, and the entries of one whose sub-index 0 is not 0, are locked.
Abort check_pdo(const ObjectDictionary& objects, const Entry& entry, std::int64_t value) EBAC_RT;

/// Identifiers that no PDO and no EMCY may take (CiA 301, table 41).
bool is_restricted(std::uint32_t id) EBAC_RT;

/// The mapping of PDO `number` (0 to 3), which `check_pdo` let through.
PdoMap read_map(const ObjectDictionary& objects, Direction direction, std::size_t number) EBAC_RT;

}  // namespace ebac::can
