#pragma once

#include <array>
#include <cstdint>

#include "ebac/core/realtime.hpp"

/// The drive's side of the state machine of CiA 402-2, as one table.
namespace ebac::can {

enum class DriveState : std::uint8_t {
  kNotReady,
  kSwitchOnDisabled,
  kReady,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStopActive,
  kFaultReaction,
  kFault,
};
inline constexpr std::size_t kDriveStates = 8;

/// Command of a controlword. `kNone`: bit 7 held, which commands nothing.
enum class DriveCommand : std::uint8_t {
  kNone,
  kDisableVoltage,
  kQuickStop,
  kShutdown,
  kSwitchOn,  // and "disable operation", the same bits
  kEnableOperation,
  kFaultReset,
};
inline constexpr std::size_t kDriveCommands = 7;

/// The state after a command. Enable operation in Ready goes through Switched on (transitions 3
/// and 4); Quick stop active leaves by it only under option codes 5 to 8 (transition 16).
inline constexpr auto kTransitions = [] {
  using Row = std::array<DriveState, kDriveCommands>;
  constexpr auto N = DriveState::kNotReady;
  constexpr auto D = DriveState::kSwitchOnDisabled;
  constexpr auto R = DriveState::kReady;
  constexpr auto S = DriveState::kSwitchedOn;
  constexpr auto E = DriveState::kOperationEnabled;
  constexpr auto Q = DriveState::kQuickStopActive;
  constexpr auto X = DriveState::kFaultReaction;
  constexpr auto F = DriveState::kFault;
  return std::array<Row, kDriveStates>{
      // none, disable voltage, quick stop, shutdown, switch on, enable operation, fault reset
      Row{N, N, N, N, N, N, N}, Row{D, D, D, R, D, D, D}, Row{R, D, D, R, S, E, R},
      Row{S, D, D, R, S, E, S}, Row{E, D, Q, R, S, E, E}, Row{Q, D, Q, Q, Q, E, Q},
      Row{X, X, X, X, X, X, X}, Row{F, F, F, F, F, F, D},
  };
}();

constexpr DriveState after(DriveState state, DriveCommand command) EBAC_RT {
  return kTransitions[static_cast<std::size_t>(state)][static_cast<std::size_t>(command)];
}

/// Where a state goes by itself: after the self-test, the quick stop (option codes 0 to 4), the
/// fault reaction.
constexpr DriveState automatic(DriveState state) EBAC_RT {
  switch (state) {
    case DriveState::kNotReady:
    case DriveState::kQuickStopActive:
      return DriveState::kSwitchOnDisabled;
    case DriveState::kFaultReaction:
      return DriveState::kFault;
    default:
      return state;
  }
}

/// The bits of the statusword that encode the state: 0x6041 & 0x6F.
constexpr std::uint16_t status_bits(DriveState state) EBAC_RT {
  constexpr std::array<std::uint16_t, kDriveStates> kBits{0x00, 0x40, 0x21, 0x23,
                                                          0x27, 0x07, 0x0F, 0x08};
  return kBits[static_cast<std::size_t>(state)];
}

/// Bits 0 to 3 and 7 of a controlword; `before` is the last one, as a fault reset is an edge.
constexpr DriveCommand command_of(std::uint16_t word, std::uint16_t before) EBAC_RT {
  if ((word & 0x80U) != 0) {
    return (before & 0x80U) != 0 ? DriveCommand::kNone : DriveCommand::kFaultReset;
  }
  if ((word & 0x02U) == 0) return DriveCommand::kDisableVoltage;
  if ((word & 0x04U) == 0) return DriveCommand::kQuickStop;
  if ((word & 0x01U) == 0) return DriveCommand::kShutdown;
  return (word & 0x08U) == 0 ? DriveCommand::kSwitchOn : DriveCommand::kEnableOperation;
}

/// Modes of operation (0x6060) this drive offers, and its 0x6502.
inline constexpr std::int8_t kNoMode = 0;
inline constexpr std::int8_t kProfileTorque = 4;
inline constexpr std::int8_t kCyclicTorque = 10;
inline constexpr std::uint32_t kSupportedModes = 1U << 3 | 1U << 9;

namespace statusword {
inline constexpr std::uint16_t kVoltage = 1U << 4;
inline constexpr std::uint16_t kWarning = 1U << 7;
inline constexpr std::uint16_t kRemote = 1U << 9;
inline constexpr std::uint16_t kTargetReached = 1U << 10;
inline constexpr std::uint16_t kInternalLimit = 1U << 11;
inline constexpr std::uint16_t kFollowsCommand = 1U << 12;  // mode 10
}  // namespace statusword

inline constexpr std::uint16_t kHalt = 1U << 8;  // controlword, mode 4

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

/// Whether a statusword says that the power is off: not ready, switch on disabled or fault. A word of no state does not.
constexpr bool power_off(std::uint16_t statusword) EBAC_RT {
  const unsigned low = statusword & 0x4FU;
  return low == 0x00 || low == 0x40 || low == 0x08;
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

/// The next command on the way to operation enabled. A fault is left alone: the loop never resets
/// it.
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
