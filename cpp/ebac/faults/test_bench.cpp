#include "ebac/faults/test_bench.hpp"

#include "ebac/canopen/torque.hpp"
#include "ebac/simulated_drives/watched_drives.hpp"

namespace ebac::faults {

namespace {

constexpr double kPress = 2;  // A
constexpr can::LoopTimes kTimes{.dt = 1e-3, .answer = 0.7e-3, .response = 50e-6};

/// The loop watches the drives, and they watch the loop.
can::CanopenSetup can_setup(const CaseSetup& made) {
  const bool guarded = made.watching.guarded > 0;
  return {.axes = made.setup.device.axes(),
          .motor_sign = made.wiring.motor,
          .encoder_sign = made.wiring.encoder,
          .encoder_zero = made.wiring.zero,
          .motor = made.setup.device.motor,
          .drive = made.setup.device.drive,
          .heartbeat_timeout = made.watching.timeout,
          .own_node = guarded ? 0 : can::kLoopNode,
          .heartbeat_period = made.watching.beat,
          .guard_period = guarded ? made.watching.beat : 0};
}

SimulatedDevice plant_of(Setup setup) {
  setup.timing.delay = 0;  // its delay is that of the bus
  setup.device.drive.permille = true;
  return SimulatedDevice(setup);
}

/// Node guarding: a fifth of the time for each request.
void guard(can::SimulatedDrive& drive, std::int64_t silence) {
  constexpr int kRequests = 5;
  drive.write(0x100C, 0, silence / kRequests);
  drive.write(0x100D, 0, kRequests);
}

/// The bus takes its time where the fault is one of the wire.
can::VirtualBus bus_of(const Setup& setup, const InjectedFault& injected) {
  if (!facts_of(injected.kind).timed) return {};
  const auto axes = static_cast<std::size_t>(setup.device.axes());
  return can::VirtualBus(can::SimulatedWire(
      {.stations = can::VirtualBus::kFirstDrive + axes, .seed = injected.chance}));
}

}  // namespace

TestBench::TestBench(const CaseSetup& made, InjectedFault& injected, Referee& referee)
    : injected_(&injected),
      referee_(&referee),
      wiring_(made.wiring),
      bus_(bus_of(made.setup, injected)),
      other_(FaultyPlant(plant_of(made.setup), injected), made.setup.device, bus_, kTimes,
             made.wiring),
      near_(bus_, injected, referee),
      can_(near_, can::OnOtherSide(other_), can_setup(made)) {
  const auto most =
      static_cast<int>(can::TorqueScale::of(made.setup.device.motor, made.setup.device.drive).most);
  for (std::size_t i = 0; i < axes(); ++i) {
    can::set_up(drive(i), most, made.watching.drives);
    if (made.watching.guarded > 0) guard(drive(i), made.watching.guarded);
  }
  near_.send(can::frame(can::kNmt, {static_cast<std::uint8_t>(can::NmtCommand::kStart), 0}));
  const int before = made.watching.before();
  for (int i = 0; i < before; ++i) static_cast<void>(can_.exchange({.elapsed = kTimes.dt}));
  can::SimulatedDrive& late = drive(injected.axis);
  if (injected.kind == Kind::kLateDrive) late.set_condition(can::Condition::kEnableMissing, true);
  if (injected.kind == Kind::kFaultAtStart) {
    late.set_condition(can::Condition::kOverVoltage, true);
    late.set_condition(can::Condition::kOverVoltage, false);
  }
}

void TestBench::spoil_drive() EBAC_RT {
  can::SimulatedDrive& drive = this->drive(injected_->axis);
  if (injected_->begins(Kind::kSilentNode)) drive.set_condition(can::Condition::kSilent, true);
  if (injected_->ends(Kind::kLateDrive)) drive.set_condition(can::Condition::kEnableMissing, false);
  const auto input =
      injected_->chance % 2 == 0 ? can::Condition::kTorqueOff : can::Condition::kEnableMissing;
  if (injected_->begins(Kind::kTorqueOff)) drive.set_condition(input, true);
  if (injected_->ends(Kind::kTorqueOff)) drive.set_condition(input, false);
  if (!injected_->begins(Kind::kDriveFault) && !injected_->begins(Kind::kUnheededFault)) return;
  constexpr std::array kAll{can::Condition::kOverVoltage, can::Condition::kOverTemperature,
                            can::Condition::kEncoderLost};
  // A lost encoder stops the counts, which the loop itself notices.
  const std::size_t some = injected_->kind == Kind::kDriveFault ? kAll.size() : 2;
  drive.set_condition(kAll[injected_->chance % some], true);
}

/// Answers late by as many milliseconds as the fault lasts, and frames that are destroyed.
void TestBench::spoil_wire() EBAC_RT {
  can::SimulatedWire* wire = bus_.wire();
  if (wire == nullptr) return;
  const bool slow = injected_->on(Kind::kSlowAnswers);
  other_.respond_after(slow ? kTimes.dt * injected_->ticks : kTimes.response);
  constexpr double kSome = 0.02;
  const double some = injected_->on(Kind::kDestroyedFrames) ? kSome : 0;
  wire->set_error_rate(can::VirtualBus::kLoop, injected_->on(Kind::kLoopOffBus) ? 1 : some);
  for (std::size_t i = 0; i < axes(); ++i) {
    const bool broken = i == injected_->axis && injected_->on(Kind::kDriveOffBus);
    wire->set_error_rate(can::VirtualBus::kFirstDrive + i, broken ? 1 : some);
  }
}

/// Torques of another master; positions of another node; an offset of up to 1.5 times the rated torque by another program, on
/// top of the loop's torque: one against it is found only when the command falls below it.
void TestBench::intrude() EBAC_RT {
  can::SimulatedDrive& drive = this->drive(injected_->axis);
  const auto size = static_cast<std::int16_t>(500 + injected_->chance % 1001);
  const int asked = can_.state(injected_->axis).target_permille;
  const int way = asked != 0 ? asked : wiring_.motor[injected_->axis];  // resists where none is
  const auto torque = static_cast<std::int16_t>(way < 0 ? -size : size);
  if (injected_->on(Kind::kSecondMaster)) {
    can::Frame frame{.id = can::rpdo(1, drive.node()), .size = can::kRpdoSize};
    can::put(frame.data, 0, can::word_of(can::DriveCommand::kEnableOperation));
    can::put(frame.data, 2, torque);
    bus_.send_as(can::VirtualBus::kOther, frame, bus_.now());
  }
  if (injected_->on(Kind::kImpostor)) {  // up to 2 mm from where the drive is
    can::Frame frame{.id = can::tpdo(1, drive.node()), .size = can::kTpdoSize};
    const can::BusRow& row = can_.state(injected_->axis);
    const auto off = static_cast<std::uint32_t>(1 + injected_->chance % 64);
    const std::int64_t counts =
        wiring_.encoder[injected_->axis] * other_.joystick().reading().counts[injected_->axis] +
        wiring_.zero[injected_->axis];
    can::put(frame.data, 0, static_cast<std::uint16_t>(row.statusword));
    can::put(frame.data, 2, static_cast<std::uint32_t>(counts) + off);
    can::put(frame.data, 6, static_cast<std::int16_t>(row.actual_permille));
    bus_.send_as(can::VirtualBus::kOther, frame, bus_.now());
  }
  if (injected_->begins(Kind::kTorqueOffset)) drive.write(0x60B2, 0, torque);
}

void TestBench::spoil_sensor(Reading& reading) EBAC_RT {
  const std::size_t axis = injected_->axis;
  if (injected_->on(Kind::kNanCurrent)) reading.current_applied[axis] = kNoNumber;
  if (injected_->on(Kind::kNanForce)) reading.force[axis] = kNoNumber;
  if (injected_->on(Kind::kForceStale)) reading.force_age = force_age_;
  if (injected_->on(Kind::kForceSaturated)) reading.force_status = SensorStatus::kSaturated;
  if (injected_->on(Kind::kForceDisconnected)) reading.force_status = SensorStatus::kDisconnected;
  if (injected_->on(Kind::kForceError)) reading.force_status = SensorStatus::kError;
}

Reading TestBench::exchange(const Command& command) EBAC_RT {
  spoil_drive();
  spoil_wire();
  intrude();
  Reading reading = can_.exchange(command);
  const Reading& seen = other_.joystick().reading();
  reading.force = seen.force;
  reading.force_status = seen.force_status;
  force_age_ = injected_->on(Kind::kForceStale) ? force_age_ + command.elapsed : 0;
  spoil_sensor(reading);
  watch(command.elapsed);
  return reading;
}

/// Shows the referee the drives and the handle.
void TestBench::watch(double elapsed) EBAC_RT {
  std::array<Seen, kMaxAxes> seen{};
  for (std::size_t i = 0; i < axes(); ++i) {
    const AxisTruth& truth = plant().state(i);
    seen[i] = {.current = wiring_.motor[i] * drive(i).current(),
               .enabled = drive(i).state() == can::DriveState::kOperationEnabled,
               .x = truth.x,
               .v = truth.v};
    if (seen[i].current != 0) injected_->last_current = injected_->tick;
  }
  referee_->watch(elapsed, std::span(seen).first(axes()));
}

Command TestBench::pressed(const Command& command) const EBAC_RT {
  Command more = command;
  if (injected_->kind == Kind::kLateDrive && !can_.running()) more.current.fill(kPress);
  return more;
}

Reading TestBench::heeded(Reading reading) const EBAC_RT {
  if (injected_->kind == Kind::kUnheededFault) reading.fault = Fault::kNone;
  return reading;
}

}  // namespace ebac::faults
