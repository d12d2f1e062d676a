#pragma once

#include <cstdint>

#include "ebac/core/realtime.hpp"

/// The state machine of a drive as its words show it (CiA 402, 8.4).
namespace ebac::can {

enum class DriveState : std::uint8_t {
  kNotReady = 0,
  kSwitchOnDisabled = 1,
  kReadyToSwitchOn = 2,
  kSwitchedOn = 3,
  kOperationEnabled = 4,
  kQuickStop = 5,
  kFaultReaction = 6,
  kFault = 7,
};

/// What a statusword (0x6041) tells.
constexpr DriveState drive_state(std::uint16_t statusword) EBAC_RT {
  switch (statusword & 0x4F) {
    case 0x00:
      return DriveState::kNotReady;
    case 0x40:
      return DriveState::kSwitchOnDisabled;
    case 0x0F:
      return DriveState::kFaultReaction;
    case 0x08:
      return DriveState::kFault;
    default:
      break;
  }
  switch (statusword & 0x6F) {
    case 0x21:
      return DriveState::kReadyToSwitchOn;
    case 0x23:
      return DriveState::kSwitchedOn;
    case 0x27:
      return DriveState::kOperationEnabled;
    case 0x07:
      return DriveState::kQuickStop;
    default:
      return DriveState::kNotReady;  // a word of no state moves nothing
  }
}

constexpr bool faulty(DriveState state) EBAC_RT {
  return state == DriveState::kFault || state == DriveState::kFaultReaction;
}

/// Commands of the controlword (0x6040).
inline constexpr std::uint16_t kDisableVoltage = 0x00;
inline constexpr std::uint16_t kQuickStopCommand = 0x02;
inline constexpr std::uint16_t kShutdown = 0x06;
inline constexpr std::uint16_t kSwitchOn = 0x07;  // and disable operation
inline constexpr std::uint16_t kEnableOperation = 0x0F;

/// The next command on the way to operation enabled; a fault stays one, resetting it is no
/// business of the loop.
constexpr std::uint16_t up_from(DriveState state) EBAC_RT {
  switch (state) {
    case DriveState::kSwitchOnDisabled:
      return kShutdown;
    case DriveState::kReadyToSwitchOn:
      return kSwitchOn;
    case DriveState::kSwitchedOn:
    case DriveState::kOperationEnabled:
      return kEnableOperation;
    default:
      return kDisableVoltage;
  }
}

/// The next command on the way to switch on disabled.
constexpr std::uint16_t down_from(DriveState state) EBAC_RT {
  switch (state) {
    case DriveState::kOperationEnabled:
      return kSwitchOn;
    case DriveState::kSwitchedOn:
      return kShutdown;
    default:
      return kDisableVoltage;
  }
}

}  // namespace ebac::can
