#pragma once

#include <array>
#include <cstdint>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

/// A tick is a row. Each stage of the loop reads the values to its left and writes its own.
///
/// Signs: x grows into the wall; a force is positive when it resists +x. Letters: q joint angle, dq
/// its rate, tau joint torque; x handle position, v its rate, f force.
namespace ebac {

/// Why the loop stopped. The first fault latches; its force is zero from that tick on.
enum class Fault : std::uint32_t {
  kNone = 0,
  kPositionNotFinite = 1,     // counts or kinematics gave no number
  kForceNotFinite = 2,        // the force sensor gave no number
  kEnvironmentNotFinite = 3,  // the force of the virtual world is not finite
  kLawNotFinite = 4,          // the law answered no number
  kTorqueNotFinite = 5,       // transpose or compensation gave no number
  kDevice = 6,                // the device itself reported a fault
  kDriveFault = 7,            // a drive is in its fault state (statusword, bit 3)
  kDriveDisabled = 8,         // a drive is not, or no longer, enabled
  kDriveSilent = 9,           // a drive gave no process data for several ticks
  kDriveEmergency = 10,       // a drive sent an emergency
  kHeartbeatLost = 11,        // a node gave no heartbeat, or is no longer operational
  kBusDown = 12,              // the bus is off, down or closed
  kEncoderJump = 13,          // an encoder moved further in a tick than the device can
  kOverspeed = 14,            // an axis moves faster than allowed
  kWorkspace = 15,            // an axis left the workspace
  kForceStale = 16,           // the force is older than allowed
  kForceSaturated = 17,       // the force sensor is at the end of its range
  kForceDisconnected = 18,    // the force sensor does not answer
  kOverruns = 19,             // too many ticks in a row came too late
  kForceError = 20,           // the force sensor reports an error of its own
  kStarved = 21,              // the law's energy account has held its force back for too long
  kTorqueMismatch = 22,       // a drive reports a torque that was not commanded
  kSecondMaster = 23,         // another node sends frames that only the loop may send
  kEncoderFrozen = 24,        // the forces must have moved an axis, its encoder shows nothing
  kTorqueReversed = 25,       // an axis moves as if its motor pushed the other way
  kMotionImplausible = 26,    // encoder, force sensor and motor contradict the model of the device
  kDuplicateNode = 27,        // two nodes send the process data of one drive
};

/// Where a loop stands. Every way out of kRun is kStop; after it, kIdle or, latched, kFault.
enum class LoopState : std::int32_t {
  kIdle = 0,   // not begun, or ended well
  kArm = 1,    // waits for the device to be enabled; no force
  kRun = 2,    // the law acts
  kStop = 3,   // force to zero, then the device stops
  kFault = 4,  // ended by a fault; stands until it is reset
};

/// Reasons for which a current was limited or increased in a tick: bits of `limited`.
enum class Limited : std::int32_t {
  kPeak = 1,        // the largest current
  kThermal = 2,     // motor temperature (i2t)
  kSlew = 4,        // the fastest change of a current
  kEdge = 8,        // the soft wall at the edge of the workspace pushes
  kRamp = 16,       // soft start, or the ramp of a stop
  kNotFinite = 32,  // was no number; zero instead
};

/// Quantities of the hardware, one per motor.
struct Joint {
  std::int64_t counts = 0;     // encoder, unwrapped
  double q = 0;                // rad
  double dq = 0;               // rad/s
  double tau = 0;              // N m, commanded
  double current = 0;          // A, commanded
  double current_applied = 0;  // A, acted over the last interval

  static constexpr auto fields() {
    using F = Field<Joint>;
    return std::array{
        F{"counts", &Joint::counts, "counts", "encoder reading, unwrapped"},
        F{"q", &Joint::q, "rad", "joint angle"},
        F{"dq", &Joint::dq, "rad/s", "joint rate, estimated"},
        F{"tau", &Joint::tau, "N m", "joint torque asked, static compensation included"},
        F{"current", &Joint::current, "A", "motor current asked"},
        F{"current_applied", &Joint::current_applied, "A",
          "motor current set by the drive over the last interval"},
    };
  }
};

/// Why the observer gives no estimate, or one that is not trusted.
enum class Fallback : std::int32_t {
  kNone = 0,         // the estimate is used
  kOff = 1,          // the scenario has no observer, or the law does not use it
  kForceStale = 2,   // the force is older than allowed
  kForceStatus = 3,  // the force sensor is saturated, disconnected or in error
  kModel = 4,        // the encoder contradicts the model for longer than a transient
  kAccount = 5,      // the law's energy account runs out with it, while the device rests
};

/// State of the device at one port, from encoder, force sensor and current: see `StateObserver`.
struct Estimate {
  double x = 0;            // m
  double dx = 0;           // m, since the last tick
  double v = 0;            // m/s
  double x_act = 0;        // m, when the command of this tick acts
  double v_act = 0;        // m/s
  double disturbance = 0;  // N
  double bound = 0;        // m
  double weight = 0;       // 1
  int fallback = static_cast<int>(Fallback::kOff);
  int spare = 0;  // to whole words

  static constexpr auto fields() {
    using F = Field<Estimate>;
    return std::array{
        F{"x", &Estimate::x, "m", "handle position, estimated"},
        F{"dx", &Estimate::dx, "m", "its change since the last tick"},
        F{"v", &Estimate::v, "m/s", "handle velocity, estimated"},
        F{"x_act", &Estimate::x_act, "m",
          "handle position predicted for the instant at which this tick's command acts"},
        F{"v_act", &Estimate::v_act, "m/s", "handle velocity predicted for that instant"},
        F{"disturbance", &Estimate::disturbance, "N",
          "force that the model of the device does not explain: friction, weight, sensor bias"},
        F{"bound", &Estimate::bound, "m",
          "largest error of x that the encoder allows, apart from an offset that stays the same: "
          "the "
          "phase of its counts, half a count at most, which no reading shows; for a rigid device"},
        F{"weight", &Estimate::weight, "1",
          "share of the estimate in what the law is given: 1 the observer, 0 the encoder alone"},
        F{"fallback", &Estimate::fallback, "1",
          "0, or why the weight goes to 0: 1 off, 2 force stale, 3 force sensor status, 4 model "
          "contradicted, 5 account "
          "drained"},
    };
  }
};

/// Quantities of the theory: the power-conjugate pair at which hand and virtual world interact.
struct Port {
  double x = 0;          // m
  double dx = 0;         // m, since the last tick
  double v = 0;          // m/s
  double dt = 0;         // s, since the last tick
  double f_env = 0;      // N, force of the virtual world (F_e)
  double f_cmd = 0;      // N, command of the law (F_d, force loop included)
  double f_applied = 0;  // N, acted over the last interval: after limits, after the delay
  double f_meas = 0;     // N, force sensor (F_M)
  double work = 0;       // J, W_k = sum of f_applied dx, static compensation left out
  double unsure = 0;     // J, largest error of `work` by what is not known of the position
  double damped = 0;     // J, energy the device's own damping dissipated
  double world_v = 0;    // m/s, of the surface of a virtual world that moves
  Estimate est{};        // of the observer

  static constexpr auto fields() {
    using F = Field<Port>;
    return std::array{
        F{"x", &Port::x, "m", "handle position; grows into the wall"},
        F{"dx", &Port::dx, "m", "displacement since the last tick"},
        F{"v", &Port::v, "m/s", "handle velocity, estimated"},
        F{"dt", &Port::dt, "s", "time since the last tick"},
        F{"f_env", &Port::f_env, "N", "force the virtual world asks for (F_e)"},
        F{"f_cmd", &Port::f_cmd, "N", "force the law commands (F_d, force loop included)"},
        F{"f_applied", &Port::f_applied, "N",
          "force that acted over the last interval, after limits and delay"},
        F{"f_meas", &Port::f_meas, "N", "force the F/T sensor measures (F_M)"},
        F{"work", &Port::work, "J",
          "energy the virtual side absorbed, sum of f_applied dx without static compensation; dx "
          "of "
          "the observer where there is one"},
        F{"unsure", &Port::unsure, "J",
          "largest error of work: the position's, half a count or est.bound, times every change of "
          "the force; for a rigid device"},
        F{"damped", &Port::damped, "J",
          "energy the device's known damping took: with the observer sum of b v^2 dt, estimated; "
          "without at least sum of (b/dt) max(|dx| - count, 0)^2"},
        F{"world_v", &Port::world_v, "m/s",
          "velocity of the virtual world's surface, where it moves and declares it"},
    };
  }
};

struct Axis {
  Joint joint;
  Port port;
};

/// One tick. A log row is the prefix of this struct that holds the axes in use.
struct Sample {
  std::int64_t tick = 0;
  double t = 0;         // s
  double lateness = 0;  // s, wake-up after the planned instant
  std::int64_t axes = 1;
  Fault fault = Fault::kNone;
  int state = static_cast<int>(LoopState::kRun);
  int limited = 0;
  int skipped = 0;  // ticks
  double ramp = 1;
  std::array<Axis, kMaxAxes> axis{};

  static constexpr auto fields() {
    using F = Field<Sample>;
    return std::array{
        F{"tick", &Sample::tick, "1", "tick number"},
        F{"t", &Sample::t, "s", "time since the start"},
        F{"lateness", &Sample::lateness, "s", "wake-up after the planned instant"},
        F{"fault", &Sample::fault, "1", "0, or why the loop stopped"},
        F{"state", &Sample::state, "1", "0 idle, 1 arm, 2 run, 3 stop, 4 fault"},
        F{"limited", &Sample::limited, "1",
          "sum of what held a current back: 1 peak, 2 thermal, 4 slew, 8 edge, 16 ramp, 32 no "
          "number"},
        F{"skipped", &Sample::skipped, "1", "ticks before this one that could not be kept"},
        F{"ramp", &Sample::ramp, "1",
          "share of the currents that was sent: below 1 in a soft start and in a stop, 0 with a "
          "fault"},
    };
  }
};

}  // namespace ebac
