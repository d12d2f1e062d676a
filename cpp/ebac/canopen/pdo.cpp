#include "ebac/canopen/pdo.hpp"

namespace ebac::can {

namespace {

constexpr std::int64_t kIdBits = 0x1FFFFFFF;
constexpr std::int64_t kExtended = 1LL << 29;

/// Bits of a data type that may stand in an RPDO for bytes to be dropped (CiA 301, 7.4.7.1), or 0.
std::size_t dummy_bits(std::uint16_t index) EBAC_RT {
  return index >= 2 && index <= 7 ? std::size_t{8} * width(static_cast<Type>(index)) : 0;
}

struct Mapped {
  Abort why = Abort::kNone;
  std::size_t slot = kNoSlot;
  std::size_t bits = 0;
};

Mapped look_up(const ObjectDictionary& objects, std::int64_t value, Direction direction) EBAC_RT {
  const auto index = static_cast<std::uint16_t>(value >> 16);
  const auto sub = static_cast<std::uint8_t>(value >> 8 & 0xFF);
  Mapped found{.bits = static_cast<std::size_t>(value & 0xFF)};
  if (direction == Direction::kReceive && sub == 0 && dummy_bits(index) != 0) {
    if (found.bits != dummy_bits(index)) found.why = Abort::kNotMappable;
    return found;
  }
  found.why = objects.locate(index, sub, found.slot);
  if (found.why != Abort::kNone) return found;
  const Entry& entry = kDriveTable.entry[found.slot];
  const Mapping wanted = direction == Direction::kReceive ? Mapping::kRpdo : Mapping::kTpdo;
  const bool offered = entry.mapping == wanted || entry.mapping == Mapping::kBoth;
  if (!offered || !objects.mappable(found.slot) || found.bits != std::size_t{8} * width(entry.type))
    found.why = Abort::kNotMappable;
  return found;
}

/// Writing sub-index 0 switches the mapping on: only now all of it must make sense.
Abort check_count(const ObjectDictionary& objects, const Entry& entry, Direction direction,
                  std::int64_t count) EBAC_RT {
  if (count > static_cast<std::int64_t>(kMapped)) return Abort::kPdoLength;
  const std::size_t first = kDriveTable.slot(entry.index, 1);
  std::size_t bits = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    if (objects.hidden(first + i)) return Abort::kPdoLength;
    const Mapped mapped = look_up(objects, objects[first + i], direction);
    if (mapped.why != Abort::kNone) return mapped.why;
    bits += mapped.bits;
  }
  return bits > 8 * Frame::kMaxSize ? Abort::kPdoLength : Abort::kNone;
}

Abort check_cob_id(Direction direction, std::int64_t present, std::int64_t value) EBAC_RT {
  if ((value & kExtended) != 0) return Abort::kValue;  // 29-bit identifiers are not offered
  if (direction == Direction::kTransmit && (value & kNoRemote) == 0) return Abort::kValue;
  if ((value & kInvalid) != 0) return Abort::kNone;
  if (is_restricted(static_cast<std::uint32_t>(value & kIdBits))) return Abort::kValue;
  const bool was_valid = (present & kInvalid) == 0;
  return was_valid && ((present ^ value) & kIdBits) != 0 ? Abort::kValue : Abort::kNone;
}

Abort check_communication(const ObjectDictionary& objects, const Entry& entry, Direction direction,
                          std::int64_t value) EBAC_RT {
  const std::int64_t cob_id = objects[kDriveTable.slot(entry.index, 1)];
  switch (entry.sub) {
    case 1:
      return check_cob_id(direction, cob_id, value);
    case 2:  // 241 to 253 are reserved or need remote frames
      return value > 240 && value < 254 ? Abort::kValue : Abort::kNone;
    case 3:
      return (cob_id & kInvalid) == 0 ? Abort::kState : Abort::kNone;
    default:
      return Abort::kNone;
  }
}

}  // namespace

bool is_restricted(std::uint32_t id) EBAC_RT {
  const auto within = [id](std::uint32_t low, std::uint32_t high) {
    return id >= low && id <= high;
  };
  return id <= 0x080 || within(0x101, 0x180) || within(0x581, 0x5FF) || within(0x601, 0x67F) ||
         within(0x6E0, 0x6FF) || id >= 0x701;
}

Abort check_pdo(const ObjectDictionary& objects, const Entry& entry, std::int64_t value) EBAC_RT {
  const Direction direction = entry.index < 0x1800 ? Direction::kReceive : Direction::kTransmit;
  const bool mapping = (entry.index & 0x0200U) != 0;
  if (!mapping) return check_communication(objects, entry, direction, value);
  const auto communication = static_cast<std::uint16_t>(entry.index - 0x0200U);
  if ((objects[kDriveTable.slot(communication, 1)] & kInvalid) == 0) return Abort::kUnsupported;
  if (entry.sub == 0) return check_count(objects, entry, direction, value);
  if (objects[kDriveTable.slot(entry.index, 0)] != 0) return Abort::kUnsupported;
  return value == 0 ? Abort::kNone : look_up(objects, value, direction).why;  // 0 empties the entry
}

PdoMap read_map(const ObjectDictionary& objects, Direction direction, std::size_t number) EBAC_RT {
  const std::size_t base = direction == Direction::kReceive ? 0x1600 : 0x1A00;
  const std::size_t first = kDriveTable.slot(static_cast<std::uint16_t>(base + number), 0);
  PdoMap map;
  map.count = static_cast<std::uint8_t>(objects[first]);
  for (std::size_t i = 0; i < map.count; ++i) {
    const Mapped mapped = look_up(objects, objects[first + 1 + i], direction);
    map.slot[i] = mapped.slot == kNoSlot ? kDummy : static_cast<std::uint16_t>(mapped.slot);
    map.size[i] = static_cast<std::uint8_t>(mapped.bits / 8);
    map.bytes = static_cast<std::uint8_t>(map.bytes + map.size[i]);
  }
  return map;
}

}  // namespace ebac::can
