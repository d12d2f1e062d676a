#pragma once

#include <cstddef>
#include <cstdint>

namespace ebac::faults {

/// Faults that a campaign injects into a run.
enum class Kind : std::uint8_t {
  kLostAnswer,
  kLateAnswer,
  kDuplicateAnswer,
  kShortAnswer,
  kCorruptAnswer,
  kLostCommand,
  kSilentNode,
  kHeartbeatOfNode,
  kHeartbeatOfLoop,
  kDriveFault,
  kEncoderJump,
  kEncoderWrap,
  kNanCurrent,
  kNanForce,
  kNanWorld,
  kNanLaw,
  kNanTorque,
  kForceStale,
  kForceSaturated,
  kForceDisconnected,
  kForceError,
  kOverruns,
  kParameterWrites,
  kStop,
  kSecondMaster,
  kTorqueOffset,
  kTorqueReversed,
  kEncoderFrozen,
  kImpostor,
  kSlowAnswers,
  kDestroyedFrames,
  kDriveOffBus,
  kLoopOffBus,
  kForceAtStart,
  kForceSwings,
  kForceHeld,
  kWorkspaceEdge,
  kWorkspaceEnd,
  kOverspeed,
  kLateDrive,
  kFaultAtStart,
  kTorqueOff,
  kBusOff,
  kUnheededFault,
  kPause,
  kNanJoint,
};
inline constexpr std::size_t kKinds = 46;

}  // namespace ebac::faults
