// What the values of a simulated drive do.
#include "ebac/can/simulated_drive.hpp"

namespace ebac::can {

namespace {

constexpr std::int64_t kSave = 0x65766173;  // "save" (CiA 301, 7.5.2.13)
constexpr std::int64_t kLoad = 0x64616F6C;  // "load" (CiA 301, 7.5.2.14)

}  // namespace

Abort SimulatedDrive::download(std::uint16_t index, std::uint8_t sub,
                               std::span<const std::uint8_t> bytes) EBAC_RT {
  const Abort why = prepare_download(index, sub, static_cast<std::int64_t>(bytes.size()));
  if (why != Abort::kNone) return why;
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
  if (kDriveTable.entry[slot].type == Type::kString) return Abort::kLength;
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
      for (const auto condition : {Condition::kOverVoltage, Condition::kEncoderLost,
                                   Condition::kOverTemperature, Condition::kSilent}) {
        set_condition(condition, (value & static_cast<std::int64_t>(condition)) != 0);
      }
      return true;
    default:
      return false;
  }
}

void SimulatedDrive::take_effect(std::size_t slot) EBAC_RT {
  const Entry& entry = kDriveTable.entry[slot];
  if (is_pdo(entry.index)) return configure_pdo(entry.index);
  switch (entry.index) {
    case 0x1003:
      for (std::size_t i = 1; i <= kHistory; ++i) objects_[slot + i] = 0;
      return;
    case 0x1006:
      return sync_watch_.set(kSyncPatience * objects_[slot] * kMicrosecond);
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
  for (std::size_t i = 1; i <= 4; ++i) take_effect(kAt<0x2383> + i);
}

}  // namespace ebac::can
