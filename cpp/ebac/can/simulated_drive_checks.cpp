// What may be read and written of a simulated drive, and when.
#include "ebac/can/simulated_drive.hpp"

namespace ebac::can {

namespace {

/// COB-IDs of SYNC and EMCY: base frames only, and none that belongs to another service.
bool is_free(std::int64_t cob_id) EBAC_RT {
  return (cob_id & ~0x7FFLL) == 0 && !is_restricted(static_cast<std::uint32_t>(cob_id));
}

template <std::size_t N>
Abort one_of(std::int64_t value, const std::array<std::int64_t, N>& offered) EBAC_RT {
  return std::ranges::find(offered, value) != offered.end() ? Abort::kNone : Abort::kValue;
}

}  // namespace

std::size_t SimulatedDrive::size_of(std::uint16_t index, std::uint8_t sub) const EBAC_RT {
  const std::size_t slot = kDriveTable.slot(index, sub);
  return slot == kNoSlot ? 0 : width(kDriveTable.entry[slot].type);
}

Abort SimulatedDrive::upload(std::uint16_t index, std::uint8_t sub, std::span<std::uint8_t> out,
                             std::size_t& size) const EBAC_RT {
  std::size_t slot = kNoSlot;
  const Abort why = ObjectDictionary::locate(index, sub, slot);
  if (why != Abort::kNone) return why;
  if (kDriveTable.entry[slot].access == Access::kWo) return Abort::kWriteOnly;
  if (index == 0x1003 && sub > objects_.get<0x1003>()) return Abort::kNoData;
  size = objects_.read(slot, out);
  return Abort::kNone;
}

Abort SimulatedDrive::prepare_download(std::uint16_t index, std::uint8_t sub,
                                       std::int64_t announced) const EBAC_RT {
  std::size_t slot = kNoSlot;
  const Abort why = ObjectDictionary::locate(index, sub, slot);
  if (why != Abort::kNone) return why;
  const Entry& entry = kDriveTable.entry[slot];
  if (entry.access == Access::kRo || entry.access == Access::kConst) return Abort::kReadOnly;
  if (entry.type == Type::kString) {
    return announced > static_cast<std::int64_t>(kTextRoom) ? Abort::kTooLong : Abort::kNone;
  }
  return announced >= 0 && announced != width(entry.type) ? Abort::kLength : Abort::kNone;
}

Abort SimulatedDrive::check(std::size_t slot, std::int64_t value) const EBAC_RT {
  const Entry& entry = kDriveTable.entry[slot];
  if (is_pdo(entry.index)) return check_pdo(objects_, entry, value);
  switch (entry.index) {
    case 0x1003:  // a 0 written empties it
      return value == 0 ? Abort::kNone : Abort::kValue;
    case 0x1005:  // consumes SYNC, does not produce it
      return value == kSync || is_free(value) ? Abort::kNone : Abort::kValue;
    case 0x1014: {
      const std::int64_t before = objects_[slot];
      const bool moved = ((before | value) & kInvalid) == 0 && before != value;
      return is_free(value & ~kInvalid) && !moved ? Abort::kNone : Abort::kValue;
    }
    case 0x1016:
      return check_producer(slot, value);
    case 0x2112:
    case 0x2383:
    case 0x6410:  // the scale of the torque must not change while there is one
      return motor_on() ? Abort::kState : Abort::kNone;
    case 0x2182:
      return one_of<2>(value, {0, facts_of(Cause::kOverload).latched});
    case 0x2300:
      if (motor_on()) return Abort::kState;
      return one_of<2>(value, {0, 30});
    case 0x605A:
      return one_of<5>(value, {0, 1, 2, 5, 6});
    case 0x6060:
      return one_of<3>(value, {kNoMode, kProfileTorque, kCyclicTorque});
    default:
      return Abort::kNone;
  }
}

/// node << 16 | ms, each node once.
Abort SimulatedDrive::check_producer(std::size_t slot, std::int64_t value) const EBAC_RT {
  const std::int64_t node = value >> 16;
  const bool used = (value & 0xFFFF) != 0 && node != 0;
  if (used && node > kLastNode) return Abort::kValue;
  for (std::size_t other = kAt<0x1016, 1>; other < kAt<0x1016, 1> + kProducers; ++other) {
    const bool same = objects_[other] >> 16 == node && (objects_[other] & 0xFFFF) != 0;
    if (used && other != slot && same) return Abort::kIncompatible;
  }
  return Abort::kNone;
}

}  // namespace ebac::can
