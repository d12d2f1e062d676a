#pragma once

#include <cstdint>

#include "ebac/can/cia402.hpp"

/// The loop's side of the state machine of CiA 402-2: what a statusword tells, what to say next.
namespace ebac::can {

/// A word of no state is "not ready": it moves nothing.
constexpr DriveState state_of(std::uint16_t statusword) EBAC_RT {
  switch (statusword & 0x4FU) {
    case 0x40:
      return DriveState::kSwitchOnDisabled;
    case 0x0F:
      return DriveState::kFaultReaction;
    case 0x08:
      return DriveState::kFault;
    default:
      break;
  }
  switch (statusword & 0x6FU) {
    case 0x21:
      return DriveState::kReady;
    case 0x23:
      return DriveState::kSwitchedOn;
    case 0x27:
      return DriveState::kOperationEnabled;
    case 0x07:
      return DriveState::kQuickStopActive;
    default:
      return DriveState::kNotReady;
  }
}

constexpr bool faulty(DriveState state) EBAC_RT {
  return state == DriveState::kFault || state == DriveState::kFaultReaction;
}

/// The controlword (0x6040) of a command; none leaves the power off.
constexpr std::uint16_t word_of(DriveCommand command) EBAC_RT {
  switch (command) {
    case DriveCommand::kQuickStop:
      return 0x02;
    case DriveCommand::kShutdown:
      return 0x06;
    case DriveCommand::kSwitchOn:
      return 0x07;
    case DriveCommand::kEnableOperation:
      return 0x0F;
    case DriveCommand::kFaultReset:
      return 0x80;
    default:
      return 0x00;
  }
}

/// The next command on the way to operation enabled. A fault stays one: to reset it is no business
/// of the loop.
constexpr DriveCommand up_from(DriveState state) EBAC_RT {
  switch (state) {
    case DriveState::kSwitchOnDisabled:
      return DriveCommand::kShutdown;
    case DriveState::kReady:
      return DriveCommand::kSwitchOn;
    case DriveState::kSwitchedOn:
    case DriveState::kOperationEnabled:
      return DriveCommand::kEnableOperation;
    default:
      return DriveCommand::kDisableVoltage;
  }
}

/// The next command on the way to switch on disabled.
constexpr DriveCommand down_from(DriveState state) EBAC_RT {
  switch (state) {
    case DriveState::kOperationEnabled:
      return DriveCommand::kSwitchOn;
    case DriveState::kSwitchedOn:
      return DriveCommand::kShutdown;
    default:
      return DriveCommand::kDisableVoltage;
  }
}

}  // namespace ebac::can
