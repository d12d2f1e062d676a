// Errors of a simulated drive: reaction, report, and end.
#include "ebac/simulated_drives/simulated_drive.hpp"

namespace ebac::can {

void SimulatedDrive::raise(Cause cause) EBAC_RT {
  if (!errors_.raise(cause)) return;
  objects_[kAt<0x2183>] |= facts_of(cause).latched;
  push_emcy(facts_of(cause).emcy);
}

namespace {

/// Whether the power stage can no longer bring the torque down by a ramp.
bool at_once(Cause cause) EBAC_RT {
  return cause == Cause::kOverVoltage || cause == Cause::kUnderVoltage ||
         cause == Cause::kShortCircuit || cause == Cause::kMotorBlocked;
}

}  // namespace

/// Stops the motor by 0x605E, or at once, and stays stopped.
void SimulatedDrive::trip(Cause cause) EBAC_RT {
  raise(cause);
  if (!faulty(state_)) state_ = DriveState::kFaultReaction;
  leaving_ = DriveState::kOperationEnabled;
  if (at_once(cause) || slope_of(objects_.get<0x605E>()) >= PowerStage::kAtOnce) stage_.off();
}

/// Ends a reported cause. A cause that stopped the drive waits for its reset.
void SimulatedDrive::cure(Cause cause) EBAC_RT {
  if (!faulty(state_) && errors_.forget(cause)) push_emcy(0);
}

void SimulatedDrive::reset_errors() EBAC_RT {
  objects_[kAt<0x2183>] = 0;
  if (errors_.reset()) push_emcy(0);
}

/// i2t holds the current at rated; 0x2183 keeps it. It is a fault only if 0x2182 is set.
void SimulatedDrive::overload() EBAC_RT {
  const std::int64_t bit = facts_of(Cause::kOverload).latched;
  objects_[kAt<0x2183>] |= bit;
  if ((objects_.get<0x2182>() & bit) == 0) return;
  trip(Cause::kOverload);
  errors_.gone(Cause::kOverload);  // without current it is over at once
}

/// Reaction to a lost heartbeat of the master (0x1029, 0x6007).
void SimulatedDrive::lose_connection(Cause cause) EBAC_RT {
  if (motor_on()) {
    switch (objects_.get<0x6007>()) {
      case 1:
        trip(cause);
        break;
      case 2:
        state_ = after(state_, DriveCommand::kDisableVoltage);
        break;
      case 3:
        state_ = after(state_, DriveCommand::kQuickStop);
        break;
      default:
        break;
    }
  }
  raise(cause);
  errors_.gone(cause);  // an event: no reset waits for the master
  if (cause == Cause::kConnection) {
    cure(cause);
    return;
  }
  const std::int64_t behaviour = objects_[kAt<0x1029, 1>];
  if (behaviour == 0 && nmt_ == NmtState::kOperational) change(NmtState::kPreOperational);
  if (behaviour == 2) change(NmtState::kStopped);
}

void SimulatedDrive::set_condition(Condition condition, bool present) EBAC_RT {
  if (condition == Condition::kSilent) {
    silent_ = present;
    if (silent_) out_.clear();
    return;
  }
  if (condition == Condition::kTorqueOff || condition == Condition::kEnableMissing) {
    (condition == Condition::kTorqueOff ? torque_off_ : enable_missing_) = present;
    if (hindered() && !faulty(state_) && state_ != DriveState::kNotReady) {
      state_ = DriveState::kSwitchOnDisabled;
      stage_.off();
    }
    return refresh();
  }
  if (condition == Condition::kBrakeStuck) {
    brake_stuck_ = present;
    if (!present) errors_.gone(Cause::kMotorBlocked);
    if (present && motor_on()) trip(Cause::kMotorBlocked);
    return refresh();
  }
  const Cause cause = [condition] {
    switch (condition) {
      case Condition::kOverVoltage:
        return Cause::kOverVoltage;
      case Condition::kEncoderLost:
        return Cause::kEncoderLost;
      case Condition::kUnderVoltage:
        return Cause::kUnderVoltage;
      case Condition::kMotorTemperature:
        return Cause::kMotorTemperature;
      case Condition::kShortCircuit:
        return Cause::kShortCircuit;
      default:
        return Cause::kOverTemperature;
    }
  }();
  if (present && !errors_.present(cause)) {
    trip(cause);
  } else if (!present) {
    errors_.gone(cause);
  }
  refresh();
}

/// Queues an EMCY and writes it into the history; code 0 reports that all errors are over.
void SimulatedDrive::push_emcy(std::uint16_t code) EBAC_RT {
  const auto latched = static_cast<std::uint32_t>(objects_.get<0x2183>());
  Frame emergency{.id = 0, .size = 8};
  put<std::uint16_t>(emergency.data, 0, code);
  emergency.data[2] = errors_.reg();
  put<std::uint32_t>(emergency.data, 3, latched);
  objects_[kAt<0x603F>] = code;
  if (code != 0) {
    std::int64_t& count = objects_[kAt<0x1003>];
    for (std::size_t i = kHistory; i > 1; --i) {
      objects_[kAt<0x1003> + i] = objects_[kAt<0x1003> + i - 1];
    }
    objects_[kAt<0x1003, 1>] = code | std::int64_t{latched & 0xFFFF} << 16;
    count = std::min<std::int64_t>(count + 1, kHistory);
  }
  emcy_.push(emergency);
  send_emcy();
}

void SimulatedDrive::send_emcy() EBAC_RT {
  const bool allowed = nmt_ == NmtState::kOperational || nmt_ == NmtState::kPreOperational;
  const std::int64_t cob_id = objects_.get<0x1014>();
  Frame emergency;
  while (allowed && now_ >= emcy_free_at_ && emcy_.pop(emergency)) {
    emergency.id = static_cast<std::uint32_t>(cob_id & 0x7FF);
    if ((cob_id & kInvalid) == 0) send(emergency);
    emcy_free_at_ = now_ + objects_.get<0x1015>() * 100 * kMicrosecond;
  }
}

}  // namespace ebac::can
