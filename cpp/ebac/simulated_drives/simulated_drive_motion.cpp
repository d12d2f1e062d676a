// From controlword to current: the state machine of CiA 402, its torque.
#include "ebac/simulated_drives/simulated_drive.hpp"

namespace ebac::can {

namespace {

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
  if (hindered()) return;  // no command leads to power
  const DriveState next = after(state_, command);
  const bool ramps = state_ == DriveState::kOperationEnabled &&
                     ((next == DriveState::kReady && objects_.get<0x605B>() == 1) ||
                      (next == DriveState::kSwitchedOn && objects_.get<0x605C>() == 1));
  leaving_ = ramps ? next : DriveState::kOperationEnabled;
  if (ramps) return;
  state_ = next;
  if (brake_stuck_ && state_ == DriveState::kOperationEnabled) trip(Cause::kMotorBlocked);
}

double SimulatedDrive::slope_of(std::int64_t option) const EBAC_RT {
  switch (option) {
    case 1:
    case 5:
      return static_cast<double>(objects_.get<0x6087>());
    case 2:
    case 6:
      return static_cast<double>(objects_.get<0x6085>());
    default:
      return PowerStage::kAtOnce;
  }
}

void SimulatedDrive::step_by_itself() EBAC_RT {
  if (state_ == DriveState::kQuickStopActive) {
    const std::int64_t option = objects_.get<0x605A>();
    if (!leaves_by_itself(option) || (option != 0 && stage_.demand() != 0)) return;
  }
  if (state_ == DriveState::kFaultReaction && stage_.demand() != 0) return;
  if (state_ == DriveState::kOperationEnabled && leaving_ != state_ && stage_.demand() == 0) {
    state_ = leaving_;
    leaving_ = DriveState::kOperationEnabled;
  }
  state_ = automatic(state_);
}

void SimulatedDrive::set_position(std::int64_t counts) EBAC_RT {
  if (errors_.present(Cause::kEncoderLost)) return;
  const std::int64_t passed = now_ - counted_at_;  // ns
  if (passed > 0) {
    constexpr double kPerSecond = 1e9 * 10;  // 0.1 counts/s from counts/ns
    const double moved = static_cast<double>(counts) - static_cast<double>(counts_);
    const double speed = moved / static_cast<double>(passed) * kPerSecond;
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
  auto most = static_cast<int>(std::min(objects_.get<0x6072>(), objects_.get<0x6073>()));
  if (objects_.described()) {  // another's limits start far above what this motor bears
    const auto peak = static_cast<double>(objects_[kAt<0x2383, 13>]) / 1e5;  // N m
    most = static_cast<int>(std::lround(std::min<double>(most, 1000 * peak / continuous)));
  }
  stage_.configure({.ampere = rated / 1000,  // eq. (1)
                    .torque = most,
                    .peak_time = static_cast<double>(objects_.get<0x2112>()) / 1000,
                    .slope = static_cast<double>(objects_.get<0x6087>())});
  // A drive that lets them be written keeps what was written.
  if (objects_.access(kAt<0x6075>) != Access::kRw) {
    objects_[kAt<0x6075>] = std::llround(std::min(rated * 1000, 4294967295.0));
  }
  if (objects_.access(kAt<0x6076>) != Access::kRw) {
    objects_[kAt<0x6076>] = std::llround(continuous * 1000);
  }
}

void SimulatedDrive::aim() EBAC_RT {
  const std::int64_t mode = objects_.get<0x6060>();
  if (state_ == DriveState::kQuickStopActive) {
    stage_.aim(0, slope_of(objects_.get<0x605A>()));
  } else if (state_ == DriveState::kFaultReaction && stage_.demand() != 0) {
    stage_.aim(0, slope_of(objects_.get<0x605E>()));
  } else if (leaving_ != DriveState::kOperationEnabled && state_ == DriveState::kOperationEnabled) {
    stage_.aim(0, /*ramp=*/true);
  } else if (state_ != DriveState::kOperationEnabled || mode == kNoMode) {
    stage_.off();
  } else if (mode == kCyclicTorque) {
    stage_.aim(static_cast<int>(objects_.get<0x6071>() + objects_.get<0x60B2>()), false);
  } else {
    const bool halt = (last_word_ & kHalt) != 0;
    if (halt) return stage_.aim(0, slope_of(objects_.get<0x605D>()));
    stage_.aim(static_cast<int>(objects_.get<0x6071>()), /*ramp=*/true);
  }
}

/// Updates the status objects.
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
  const auto bit = [](bool set, unsigned at) { return std::int64_t{set ? 1 : 0} << at; };
  objects_[kAt<0x60FD>] = bit(enable_missing_, 3) | bit(torque_off_, 16);
  objects_[kAt<0x60FE, 1>] = bit(!motor_on() || brake_stuck_, 0);
}

std::uint16_t SimulatedDrive::status() const EBAC_RT {
  std::uint16_t word = status_bits(state_);
  const bool supplied = !torque_off_ && !errors_.present(Cause::kUnderVoltage);
  if (supplied) word |= statusword::kVoltage;
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
  if (faulty(state_)) bits |= 1U << 22;
  return bits;
}

}  // namespace ebac::can
