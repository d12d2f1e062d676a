#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "ebac/core/sample.hpp"

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
};
inline constexpr std::size_t kKinds = 33;

struct KindFacts {
  std::string_view name;
  std::string_view what;
  /// Ticks it lasts at least, and at most.
  int shortest, longest;
  /// From this many ticks on it must be found; 0: it never is a fault.
  int fatal;
  /// So many ticks below that, finding it and not finding it are both right.
  int slack;
  /// Faults by which it may be reported.
  std::array<Fault, 3> faults;
  /// Tick in which it begins, at the earliest and the latest.
  int first = 30, last = 180;
  /// Whether its bus takes time.
  bool timed = false;
};

inline constexpr int kForEver = 1'000'000;

inline constexpr std::array<KindFacts, kKinds> kKindFacts{{
    {"lost_answer", "process data of a drive do not arrive", 1, 8, 3, 0, {Fault::kDriveSilent}},
    {"late_answer", "process data arrive a tick late", 1, 40, 0, 0, {}},
    {"duplicate_answer", "process data arrive twice", 1, 40, 0, 0, {}},
    {"short_answer", "process data arrive without their end", 1, 8, 3, 0, {Fault::kDriveSilent}},
    {"corrupt_answer", "a bit of the position is wrong", 1, 3, 1, 0, {Fault::kEncoderJump}},
    {"lost_command", "torques do not arrive at a drive", 1, 20, 8, 4, {Fault::kDriveEmergency}},
    {"silent_node",
     "a drive hears and says nothing",
     kForEver,
     kForEver,
     1,
     0,
     {Fault::kDriveSilent}},
    {"heartbeat_of_node",
     "the heartbeat of a drive does not arrive",
     kForEver,
     kForEver,
     1,
     0,
     {Fault::kHeartbeatLost}},
    {"heartbeat_of_loop",
     "a drive does not hear the heartbeat of the loop",
     kForEver,
     kForEver,
     1,
     0,
     {Fault::kDriveEmergency}},
    {"drive_fault",
     "over-voltage, over-temperature or a lost encoder",
     kForEver,
     kForEver,
     1,
     0,
     {Fault::kDriveEmergency, Fault::kDriveFault}},
    {"encoder_jump", "the counts jump", kForEver, kForEver, 1, 0, {Fault::kEncoderJump}},
    {"encoder_wrap", "an 11-bit counter overflows", kForEver, kForEver, 0, 0, {}},
    {"nan_current", "the current reported is no number", 1, 1, 1, 0, {Fault::kDevice}},
    {"nan_force", "the force sensor gives no number", 1, 1, 1, 0, {Fault::kForceNotFinite}},
    {"nan_world",
     "the virtual world asks for no number",
     1,
     1,
     1,
     0,
     {Fault::kEnvironmentNotFinite}},
    {"nan_law", "the law answers no number", 1, 1, 1, 0, {Fault::kLawNotFinite}},
    {"nan_torque", "the compensation gives no number", 1, 1, 1, 0, {Fault::kTorqueNotFinite}},
    {"force_stale", "the force does not change any more", 1, 60, 22, 2, {Fault::kForceStale}},
    {"force_saturated", "the force sensor is at its end", 1, 20, 1, 0, {Fault::kForceSaturated}},
    {"force_disconnected",
     "the force sensor does not answer",
     1,
     20,
     1,
     0,
     {Fault::kForceDisconnected}},
    {"force_error", "the force sensor reports an error", 1, 20, 1, 0, {Fault::kForceError}},
    {"overruns", "ticks come one or two too late", 1, 20, 10, 0, {Fault::kOverruns}},
    {"parameter_writes", "gains and walls change at any moment", kForEver, kForEver, 0, 0, {}},
    {"stop", "a stop is asked for", 1, 1, 0, 0, {}},
    {"second_master", "another node sends torques to a drive", 1, 40, 1, 0, {Fault::kSecondMaster}},
    {"torque_offset",
     "an offset (0x60B2) adds to the torque of a drive",
     kForEver,
     kForEver,
     1,
     0,
     {Fault::kTorqueMismatch, Fault::kOverspeed, Fault::kWorkspace}},
    {"torque_reversed",
     "a motor pushes the other way, in contact",
     kForEver,
     kForEver,
     1,
     0,
     {Fault::kTorqueReversed, Fault::kOverspeed, Fault::kWorkspace},
     100,
     150},
    {"encoder_frozen",
     "the counts stand still while the hand moves",
     kForEver,
     kForEver,
     1,
     0,
     {Fault::kEncoderFrozen},
     50,
     65},
    {"impostor",
     "another node sends the position of a drive",
     1,
     40,
     3,
     2,
     {Fault::kDuplicateNode, Fault::kEncoderJump}},
    {"slow_answers",
     "the drives take milliseconds to answer",
     1,
     8,
     3,
     0,
     {Fault::kDriveSilent},
     30,
     180,
     true},
    {"destroyed_frames", "frames are destroyed on the wire", 1, 40, 0, 0, {}, 30, 180, true},
    {"drive_off_bus",
     "every frame of a drive is destroyed: it goes off the bus",
     kForEver,
     kForEver,
     1,
     0,
     {Fault::kDriveSilent},
     30,
     180,
     true},
    {"loop_off_bus",
     "every frame of the loop is destroyed: it goes off the bus",
     kForEver,
     kForEver,
     1,
     0,
     {Fault::kBusDown, Fault::kDriveSilent},
     30,
     180,
     true},
}};

constexpr const KindFacts& facts_of(Kind kind) {
  return kKindFacts[static_cast<std::size_t>(kind)];
}

}  // namespace ebac::faults
