// The object dictionary of a simulated drive: access checks, and the effects of its values.

#include "ebac/simulated_drives/simulated_drive.hpp"

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
  if (slot != kNoSlot) return width(kDriveTable.entry[slot].type);
  const std::size_t extra = objects_.extra(index, sub);
  return extra == kNoSlot ? 0 : objects_.extra_entry(extra).width;
}

Abort SimulatedDrive::upload(std::uint16_t index, std::uint8_t sub, std::span<std::uint8_t> out,
                             std::size_t& size) const EBAC_RT {
  if (const std::size_t extra = objects_.extra(index, sub); extra != kNoSlot) {
    if (objects_.extra_entry(extra).access == Access::kWo) return Abort::kWriteOnly;
    size = objects_.read_extra(extra, out);
    return Abort::kNone;
  }
  std::size_t slot = kNoSlot;
  const Abort why = objects_.locate(index, sub, slot);
  if (why != Abort::kNone) return why;
  if (objects_.access(slot) == Access::kWo) return Abort::kWriteOnly;
  if (index == 0x1003 && sub > objects_.get<0x1003>()) return Abort::kNoData;
  size = objects_.read(slot, out);
  return Abort::kNone;
}

Abort SimulatedDrive::prepare_download(std::uint16_t index, std::uint8_t sub,
                                       std::int64_t announced) const EBAC_RT {
  const auto fixed = [](Access access) {
    return access == Access::kRo || access == Access::kConst;
  };
  if (const std::size_t extra = objects_.extra(index, sub); extra != kNoSlot) {
    const SheetEntry& entry = objects_.extra_entry(extra);
    if (fixed(entry.access)) return Abort::kReadOnly;
    const bool fits = announced < 0 || entry.width == 0 || announced == entry.width;
    return fits ? Abort::kNone : Abort::kLength;
  }
  std::size_t slot = kNoSlot;
  const Abort why = objects_.locate(index, sub, slot);
  if (why != Abort::kNone) return why;
  const Entry& entry = kDriveTable.entry[slot];
  if (fixed(objects_.access(slot))) return Abort::kReadOnly;
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
    case 0x1019:  // only while no SYNC is expected (CiA 301, 7.5.2.22)
      if (objects_.get<0x1006>() != 0) return Abort::kState;
      return value == 1 ? Abort::kValue : Abort::kNone;
    case 0x605A:
      return one_of<5>(value, {0, 1, 2, 5, 6});
    case 0x605B:
    case 0x605C:
      return one_of<2>(value, {0, 1});
    case 0x605D:
      return one_of<3>(value, {1, 2, 3});
    case 0x605E:
      return one_of<3>(value, {0, 1, 2});
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

namespace {

constexpr std::int64_t kSave = 0x65766173;  // "save" (CiA 301, 7.5.2.13)
constexpr std::int64_t kLoad = 0x64616F6C;  // "load" (CiA 301, 7.5.2.14)

}  // namespace

Abort SimulatedDrive::download(std::uint16_t index, std::uint8_t sub,
                               std::span<const std::uint8_t> bytes) EBAC_RT {
  const Abort why = prepare_download(index, sub, static_cast<std::int64_t>(bytes.size()));
  if (why != Abort::kNone) return why;
  if (const std::size_t extra = objects_.extra(index, sub); extra != kNoSlot) {
    return objects_.write_extra(extra, bytes);
  }
  const std::size_t slot = kDriveTable.slot(index, sub);
  const Entry& entry = kDriveTable.entry[slot];
  if (entry.type == Type::kString) {
    objects_.set_text(entry, bytes);
    return Abort::kNone;
  }
  return set(slot, ObjectDictionary::number(entry, bytes));
}

Abort SimulatedDrive::write(std::uint16_t index, std::uint8_t sub, std::int64_t value) EBAC_RT {
  const Abort why = prepare_download(index, sub, -1);
  if (why != Abort::kNone) return why;
  const std::size_t slot = kDriveTable.slot(index, sub);
  if (slot == kNoSlot || kDriveTable.entry[slot].type == Type::kString) return Abort::kLength;
  const Abort refused = set(slot, value);
  refresh();
  return refused;
}

/// The one way by which SDO and RPDO change a number.
Abort SimulatedDrive::set(std::size_t slot, std::int64_t value) EBAC_RT {
  Abort why = ObjectDictionary::check_limits(kDriveTable.entry[slot], value);
  if (why == Abort::kNone) why = check(slot, value);
  if (why != Abort::kNone || execute(slot, value, why)) return why;
  objects_[slot] = value;
  take_effect(slot);
  return Abort::kNone;
}

/// Objects that are orders and keep no value; true when `slot` was one.
bool SimulatedDrive::execute(std::size_t slot, std::int64_t value, Abort& why) EBAC_RT {
  switch (kDriveTable.entry[slot].index) {
    case 0x1010:
    case 0x1011: {
      const bool save = kDriveTable.entry[slot].index == 0x1010;
      if (value != (save ? kSave : kLoad)) {
        why = Abort::kNotStored;
      } else if (motor_on()) {
        why = Abort::kState;
      } else if (save) {
        objects_.store();
      } else {
        objects_.forget();
      }
      return true;
    }
    case 0x2183: {
      std::int64_t kept = errors_.latched();
      if (stage_.holding()) kept |= facts_of(Cause::kOverload).latched;
      objects_[slot] &= ~(value & ~kept);
      return true;
    }
    case 0x5F00:
    case 0x5F01: {
      const unsigned shift = kDriveTable.entry[slot].index == 0x5F00 ? 0 : 8;
      for (unsigned bit = 0; bit < (shift == 0 ? 8U : 2U); ++bit) {
        set_condition(static_cast<Condition>(1U << (bit + shift)), (value >> bit & 1) != 0);
      }
      return true;
    }
    default:
      return false;
  }
}

void SimulatedDrive::take_effect(std::size_t slot) EBAC_RT {
  const Entry& entry = kDriveTable.entry[slot];
  if (is_pdo(entry.index)) return configure_pdo(entry.index);
  switch (entry.index) {
    case 0x1003:
      for (std::size_t i = 1; entry.sub == 0 && i <= kHistory; ++i) objects_[slot + i] = 0;
      return;
    case 0x1006:
      return sync_watch_.set(kSyncPatience * objects_[slot] * kMicrosecond);
    case 0x100C:
    case 0x100D:
      return life_.set(objects_.get<0x100C>() * objects_.get<0x100D>() * kMillisecond);
    case 0x1016:
      return producer_[slot - kAt<0x1016, 1>].set((objects_[slot] & 0xFFFF) * kMillisecond);
    case 0x1017:
      return heartbeat_.start(now_, objects_[slot] * kMillisecond);
    case 0x2383:
    case 0x6410: {  // one motor under two indices
      const bool former = entry.index == 0x6410;
      const std::size_t twin =
          former ? slot - kAt<0x6410> + kAt<0x2383> : slot - kAt<0x2383> + kAt<0x6410>;
      objects_[twin] = objects_[slot];
      return limit();
    }
    case 0x2112:
    case 0x6072:
    case 0x6073:
    case 0x6087:
      return limit();
    case 0x6040:
      return command_drive(static_cast<std::uint16_t>(objects_[slot]));
    default:
      return;
  }
}

void SimulatedDrive::configure_pdo(std::uint16_t index) EBAC_RT {
  const std::size_t number = index & 0xFFU;
  if (index < 0x1800) {
    rpdo_[number].configure(objects_, number);
  } else {
    tpdo_[number].configure(objects_, number, now_);
  }
}

void SimulatedDrive::configure_all() EBAC_RT {
  for (std::size_t i = 0; i < kPdos; ++i) {
    rpdo_[i].configure(objects_, i);
    tpdo_[i].configure(objects_, i, now_);
  }
  for (std::size_t i = 0; i < kProducers; ++i) take_effect(kAt<0x1016, 1> + i);
  take_effect(kAt<0x1006>);
  take_effect(kAt<0x1017>);
  take_effect(kAt<0x100C>);
  for (std::size_t i = 1; i <= 4; ++i) take_effect(kAt<0x2383> + i);
}

}  // namespace ebac::can
