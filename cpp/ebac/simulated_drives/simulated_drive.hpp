#pragma once

#include "ebac/can/frame_queue.hpp"
#include "ebac/canopen/cob_id.hpp"
#include "ebac/canopen/lss.hpp"
#include "ebac/canopen/pdo.hpp"
#include "ebac/canopen/sdo_server.hpp"
#include "ebac/model/motor.hpp"
#include "ebac/simulated_drives/drive_errors.hpp"
#include "ebac/simulated_drives/power_stage.hpp"

namespace ebac::can {

/// How a simulated drive comes to its machine.
struct DriveSettings {
  NodeId node = 1;
  Motor motor{};
  Drive drive{};                        // its peak torque is the default of 0x6072
  int counts_per_turn = 1024;           // counts
  double peak_time = 2;                 // s, at the peak current before i2t acts
  std::span<const SheetEntry> sheet{};  // whose dictionary it has; empty: its own
};

/// Conditions that can be injected into a drive; bits of 0x5F00, and from 256 on of 0x5F01.
enum class Condition : std::uint16_t {
  kOverVoltage = 1,
  kEncoderLost = 2,
  kOverTemperature = 4,
  kSilent = 8,  // neither receives nor sends
  kUnderVoltage = 16,
  kMotorTemperature = 32,
  kShortCircuit = 64,
  kTorqueOff = 128,      // safe torque off (STO): no power, no fault
  kEnableMissing = 256,  // the enable input is open: no operation, no fault
  kBrakeStuck = 512,     // the brake does not open
};

/// A CANopen servo drive (CiA 301, CiA 402-2): a state machine that takes frames, lets time pass
/// and leaves frames. It has no clock, no thread, and allocates nothing.
class SimulatedDrive {
 public:
  SimulatedDrive() : SimulatedDrive(DriveSettings{}) {}
  explicit SimulatedDrive(const DriveSettings& settings);

  void receive(const Frame& frame) EBAC_RT;
  /// Lets `ns` pass: heartbeats, timers, ramps, i2t, and transitions that need no command.
  void elapse(std::int64_t ns) EBAC_RT;
  /// The next frame on its way out; false where none is.
  bool take(Frame& frame) EBAC_RT { return out_.pop(frame); }

  /// Sets the present encoder counts.
  void set_position(std::int64_t counts) EBAC_RT;
  /// Present motor current [A]. Zero unless the operation is enabled.
  double current() const EBAC_RT { return stage_.current(); }
  int torque() const EBAC_RT { return stage_.torque(); }  // permille of the continuous torque

  void set_condition(Condition condition, bool present) EBAC_RT;

  /// Whether this frame is the SYNC this drive waits for.
  bool is_sync(const Frame& frame) const EBAC_RT;
  NodeId node() const EBAC_RT { return objects_.node(); }
  NmtState nmt() const EBAC_RT { return nmt_; }
  DriveState state() const EBAC_RT { return state_; }
  /// Whether the motor is under control.
  bool motor_on() const EBAC_RT {
    return state_ == DriveState::kOperationEnabled || state_ == DriveState::kQuickStopActive;
  }
  const ObjectDictionary& objects() const EBAC_RT { return objects_; }
  std::uint64_t frames_refused() const EBAC_RT { return out_.refused(); }

  // Object access of the SDO server; also configures a drive without a bus.
  Abort prepare_download(std::uint16_t index, std::uint8_t sub,
                         std::int64_t announced) const EBAC_RT;
  Abort download(std::uint16_t index, std::uint8_t sub,
                 std::span<const std::uint8_t> bytes) EBAC_RT;
  Abort upload(std::uint16_t index, std::uint8_t sub, std::span<std::uint8_t> out,
               std::size_t& size) const EBAC_RT;
  std::size_t size_of(std::uint16_t index, std::uint8_t sub) const EBAC_RT;
  /// Writes a number as an SDO client would.
  Abort write(std::uint16_t index, std::uint8_t sub, std::int64_t value) EBAC_RT;

 private:
  // frames and time: simulated_drive.cpp
  void send(const Frame& frame) EBAC_RT;
  void start_as(std::span<const SheetEntry> sheet);
  void command_node(std::uint8_t command) EBAC_RT;
  void enter(NmtState next) EBAC_RT;
  void change(NmtState next) EBAC_RT;
  void boot(std::uint16_t last_index) EBAC_RT;
  void synchronise(const Frame& frame) EBAC_RT;
  void guard() EBAC_RT;
  void set_layer(const Frame& frame) EBAC_RT;
  void receive_pdo(const Frame& frame) EBAC_RT;
  void apply(const Rpdo& rpdo, const Frame& frame) EBAC_RT;
  void hear_heartbeat(const Frame& frame) EBAC_RT;
  void watch() EBAC_RT;
  void send_events() EBAC_RT;

  // access checks: simulated_drive_objects.cpp
  Abort check(std::size_t slot, std::int64_t value) const EBAC_RT;
  Abort check_producer(std::size_t slot, std::int64_t value) const EBAC_RT;

  // effects of the values: simulated_drive_objects.cpp
  Abort set(std::size_t slot, std::int64_t value) EBAC_RT;
  bool execute(std::size_t slot, std::int64_t value, Abort& why) EBAC_RT;
  void take_effect(std::size_t slot) EBAC_RT;
  void configure_pdo(std::uint16_t index) EBAC_RT;
  void configure_all() EBAC_RT;

  // the motor: simulated_drive_motion.cpp
  void command_drive(std::uint16_t word) EBAC_RT;
  void step_by_itself() EBAC_RT;
  void limit() EBAC_RT;
  void aim() EBAC_RT;
  void refresh() EBAC_RT;
  std::uint16_t status() const EBAC_RT;
  std::uint32_t events() const EBAC_RT;
  /// The slope by which an option code takes the torque off [permille/s].
  double slope_of(std::int64_t option) const EBAC_RT;
  bool hindered() const EBAC_RT { return torque_off_ || enable_missing_; }
  bool remote() const EBAC_RT { return objects_.get<0x2300>() == 30; }

  // errors: simulated_drive_errors.cpp
  void raise(Cause cause) EBAC_RT;
  void trip(Cause cause) EBAC_RT;
  void cure(Cause cause) EBAC_RT;
  void reset_errors() EBAC_RT;
  void overload() EBAC_RT;
  void lose_connection(Cause cause) EBAC_RT;
  void push_emcy(std::uint16_t code) EBAC_RT;
  void send_emcy() EBAC_RT;

  ObjectDictionary objects_;
  SdoServer sdo_;
  LssSlave lss_;
  std::array<Rpdo, kPdos> rpdo_;
  std::array<Tpdo, kPdos> tpdo_;
  std::array<Watchdog, kProducers> producer_;
  Watchdog sync_watch_;
  Watchdog life_;  // of node guarding
  std::uint8_t guard_toggle_ = 0;
  std::int64_t synced_at_ = kNever;  // ns
  Timer heartbeat_;
  ErrorState errors_;
  FrameQueue<8> emcy_;
  std::int64_t emcy_free_at_ = 0;  // ns
  FrameQueue<64> out_;
  std::int64_t now_ = 0;  // ns
  NmtState nmt_ = NmtState::kBoot;
  DriveState state_ = DriveState::kNotReady;
  std::uint16_t last_word_ = 0;  // controlword
  PowerStage stage_;
  DriveState leaving_ = DriveState::kOperationEnabled;  // to go to once the torque is off
  bool silent_ = false;
  bool torque_off_ = false;
  bool enable_missing_ = false;
  bool brake_stuck_ = false;
  std::int64_t counts_ = 0;      // encoder
  std::int64_t counted_at_ = 0;  // ns
};

static_assert(SdoObjects<SimulatedDrive>);

}  // namespace ebac::can
