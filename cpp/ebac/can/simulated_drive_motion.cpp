// From controlword to current: the state machine of CiA 402, its faults, its torque.
#include "ebac/can/simulated_drive.hpp"

namespace ebac::can {

namespace {

bool in_fault(DriveState state) EBAC_RT {
  return state == DriveState::kFault || state == DriveState::kFaultReaction;
}

/// Option codes of 0x605A under which Quick stop active is left by itself.
bool leaves_by_itself(std::int64_t option) EBAC_RT { return option < 5; }

}  // namespace

void SimulatedDrive::command_drive(std::uint16_t word) EBAC_RT {
  const DriveCommand command = command_of(word, last_word_);
  last_word_ = word;
  if (!remote()) return;  // under another's command
  if (command == DriveCommand::kFaultReset) {
    if (state_ == DriveState::kFault && !errors_.any_present()) {
      reset_errors();
      state_ = after(state_, command);
    }
    return;
  }
  const bool resumes =
      state_ == DriveState::kQuickStopActive && command == DriveCommand::kEnableOperation;
  if (resumes && leaves_by_itself(objects_.get<0x605A>())) return;
  state_ = after(state_, command);
}

void SimulatedDrive::step_by_itself() EBAC_RT {
  if (state_ == DriveState::kQuickStopActive) {
    const std::int64_t option = objects_.get<0x605A>();
    if (!leaves_by_itself(option) || (option != 0 && stage_.demand() != 0)) return;
  }
  state_ = automatic(state_);
}

void SimulatedDrive::raise(Cause cause) EBAC_RT {
  if (!errors_.raise(cause)) return;
  const CauseFacts& facts = facts_of(cause);
  objects_[kAt<0x2183>] |= facts.latched;
  if (cause == Cause::kOverload) {  // a limit unless 0x2182 makes it a fault: told by bits alone
    if ((objects_.get<0x2182>() & facts.latched) == 0) return;
    errors_.gone(cause);  // without current it is over at once
    return trip(cause);
  }
  push_emcy(facts.emcy);
}

/// Stops the motor and stays stopped.
void SimulatedDrive::trip(Cause cause) EBAC_RT {
  if (cause == Cause::kOverload) push_emcy(facts_of(cause).emcy);
  if (!in_fault(state_)) state_ = DriveState::kFaultReaction;
  stage_.off();
}

/// The cause is over. Where it had stopped the drive, the reset waits for the controlword.
void SimulatedDrive::cure(Cause cause) EBAC_RT {
  if (!errors_.present(cause)) return;
  errors_.gone(cause);
  if (!in_fault(state_)) reset_errors();
}

void SimulatedDrive::reset_errors() EBAC_RT {
  const bool any = errors_.reset();
  if (errors_.any_active()) return;
  if (any) {
    push_emcy(0);
    objects_[kAt<0x2183>] = 0;
  }
}

/// What 0x1029 and 0x6007 say about a master that is not heard any more.
void SimulatedDrive::lose_connection(Cause cause) EBAC_RT {
  raise(cause);
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
  if (cause == Cause::kConnection) {
    errors_.gone(cause);  // an event, not a condition
    return;
  }
  if (nmt_ != NmtState::kOperational) return;
  const std::int64_t behaviour = objects_[kAt<0x1029, 1>];
  if (behaviour == 0) enter(NmtState::kPreOperational);
  if (behaviour == 2) enter(NmtState::kStopped);
}

void SimulatedDrive::set_condition(Condition condition, bool present) EBAC_RT {
  if (condition == Condition::kSilent) {
    silent_ = present;
    if (silent_) out_.clear();
    return;
  }
  const Cause cause = condition == Condition::kOverVoltage   ? Cause::kOverVoltage
                      : condition == Condition::kEncoderLost ? Cause::kEncoderLost
                                                             : Cause::kOverTemperature;
  if (present && !errors_.present(cause)) {
    raise(cause);
    trip(cause);
  } else if (!present) {
    errors_.gone(cause);
  }
  refresh();
}

/// Queues an EMCY and writes it into the history; code 0 tells that the errors are over.
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

void SimulatedDrive::set_position(std::int64_t counts) EBAC_RT {
  if (errors_.present(Cause::kEncoderLost)) return;
  const std::int64_t passed = now_ - counted_at_;  // ns
  if (passed > 0) {
    constexpr double kPerSecond = 1e9 * 10;  // 0.1 counts/s from counts/ns
    const double speed =
        static_cast<double>(counts - counts_) / static_cast<double>(passed) * kPerSecond;
    objects_[kAt<0x606C>] = std::llround(std::clamp(speed, -2147483648.0, 2147483647.0));
  }
  counts_ = counts;
  counted_at_ = now_;
  objects_[kAt<0x6064>] = static_cast<std::int32_t>(static_cast<std::uint32_t>(counts));
}

/// The limits of the power stage from the objects that set them. Torque is in thousandths of the
/// motor's continuous torque, current of the current that gives it: the same number.
void SimulatedDrive::limit() EBAC_RT {
  const double constant = static_cast<double>(objects_[kAt<0x2383, 12>]) / 1e5;    // N m/A
  const double continuous = static_cast<double>(objects_[kAt<0x2383, 14>]) / 1e5;  // N m
  const double rated = continuous / constant;                                      // A
  const auto most = static_cast<int>(std::min(objects_.get<0x6072>(), objects_.get<0x6073>()));
  stage_.configure({.ampere = rated / 1000,  // eq. (1)
                    .torque = most,
                    .peak_time = static_cast<double>(objects_.get<0x2112>()) / 1000,
                    .slope = static_cast<double>(objects_.get<0x6087>())});
  objects_[kAt<0x6075>] = std::llround(std::min(rated * 1000, 4294967295.0));
  objects_[kAt<0x6076>] = std::llround(continuous * 1000);
}

void SimulatedDrive::aim() EBAC_RT {
  const std::int64_t mode = objects_.get<0x6060>();
  if (state_ == DriveState::kQuickStopActive) {
    const std::int64_t option = objects_.get<0x605A>();
    stage_.aim(0, /*ramp=*/option == 1 || option == 5);
  } else if (state_ != DriveState::kOperationEnabled || mode == kNoMode) {
    stage_.off();
  } else if (mode == kCyclicTorque) {
    stage_.aim(static_cast<int>(objects_.get<0x6071>() + objects_.get<0x60B2>()), false);
  } else {
    const bool halt = (last_word_ & kHalt) != 0;
    stage_.aim(halt ? 0 : static_cast<int>(objects_.get<0x6071>()), /*ramp=*/true);
  }
}

/// Brings every object that tells something up to date.
void SimulatedDrive::refresh() EBAC_RT {
  aim();
  const auto i16 = [](double value) { return std::llround(std::clamp(value, -32768.0, 32767.0)); };
  objects_[kAt<0x1001>] = errors_.reg();
  objects_[kAt<0x1002>] = events();
  objects_[kAt<0x6041>] = status();
  objects_[kAt<0x6061>] = objects_.get<0x6060>();
  objects_[kAt<0x6074>] = i16(stage_.demand());
  objects_[kAt<0x6077>] = i16(stage_.torque());
  objects_[kAt<0x6078>] = objects_.get<0x6077>();
}

std::uint16_t SimulatedDrive::status() const EBAC_RT {
  std::uint16_t word = status_bits(state_) | statusword::kVoltage;
  const std::int64_t mode = objects_.get<0x6060>();
  const bool enabled = state_ == DriveState::kOperationEnabled;
  if (remote()) word |= statusword::kRemote;
  if (stage_.holding()) word |= statusword::kWarning;
  if (stage_.limited()) word |= statusword::kInternalLimit;
  if (enabled && mode == kProfileTorque && stage_.reached()) word |= statusword::kTargetReached;
  if (enabled && mode == kCyclicTorque) word |= statusword::kFollowsCommand;
  return word;
}

/// 0x1002, bits as Copley counts them (indicative).
std::uint32_t SimulatedDrive::events() const EBAC_RT {
  std::uint32_t bits = errors_.events();
  if (stage_.limited()) bits |= facts_of(Cause::kOverload).event;
  if (!motor_on()) bits |= 1U << 12 | 1U << 15;  // disabled by software, bridge off
  if (in_fault(state_)) bits |= 1U << 22;
  return bits;
}

}  // namespace ebac::can
