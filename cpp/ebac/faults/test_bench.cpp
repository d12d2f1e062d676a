#include "ebac/faults/test_bench.hpp"

#include "ebac/canopen/torque.hpp"
#include "ebac/simulated_drives/watched_drives.hpp"

namespace ebac::faults {

namespace {

constexpr can::Watches kWatches{.drive_heartbeat = 10, .loop_silence = 50, .torque_silence = 5};
constexpr can::LoopTimes kTimes{.dt = 1e-3, .answer = 0.7e-3, .response = 50e-6};

/// The loop watches the drives, and they watch the loop.
can::CanopenSetup can_setup(const DeviceModel& device) {
  return {.axes = device.axes(),
          .motor = device.motor,
          .drive = device.drive,
          .heartbeat_timeout = 1e-3 * static_cast<double>(kWatches.loop_silence),
          .own_node = can::kLoopNode,
          .heartbeat_period = 1e-3 * static_cast<double>(kWatches.drive_heartbeat)};
}

SimulatedDevice plant_of(Setup setup) {
  setup.timing.delay = 0;  // its delay is that of the bus
  setup.device.drive.permille = true;
  return SimulatedDevice(setup);
}

constexpr int kBefore =
    2 * kWatches.drive_heartbeat;  // ticks of 1 ms, until every drive is operational

/// The bus takes its time where the fault is one of the wire.
can::VirtualBus bus_of(const Setup& setup, const InjectedFault& injected) {
  if (!facts_of(injected.kind).timed) return {};
  const auto axes = static_cast<std::size_t>(setup.device.axes());
  return can::VirtualBus(can::SimulatedWire(
      {.stations = can::VirtualBus::kFirstDrive + axes, .seed = injected.chance}));
}

}  // namespace

TestBench::TestBench(const Setup& setup, InjectedFault& injected)
    : injected_(&injected),
      bus_(bus_of(setup, injected)),
      other_(FaultyPlant(plant_of(setup), injected), setup.device, bus_, kTimes),
      near_(bus_, injected),
      can_(near_, can::OnOtherSide(other_), can_setup(setup.device)) {
  const auto most =
      static_cast<int>(can::TorqueScale::of(setup.device.motor, setup.device.drive).most);
  for (std::size_t i = 0; i < axes(); ++i) can::set_up(drive(i), most, kWatches);
  near_.send(can::frame(can::kNmt, {static_cast<std::uint8_t>(can::NmtCommand::kStart), 0}));
  for (int i = 0; i < kBefore; ++i) static_cast<void>(can_.exchange({.elapsed = 1e-3}));
}

void TestBench::spoil_drive() EBAC_RT {
  can::SimulatedDrive& drive = this->drive(injected_->axis);
  if (injected_->begins(Kind::kSilentNode)) drive.set_condition(can::Condition::kSilent, true);
  if (injected_->begins(Kind::kDriveFault)) {
    constexpr std::array kAll{can::Condition::kOverVoltage, can::Condition::kEncoderLost,
                              can::Condition::kOverTemperature};
    drive.set_condition(kAll[injected_->chance % kAll.size()], true);
  }
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
  const auto torque = static_cast<std::int16_t>(asked < 0 ? -size : size);
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
    const std::int64_t counts = other_.joystick().reading().counts[injected_->axis];
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
  for (std::size_t i = 0; i < axes(); ++i) {
    const double current = std::abs(drive(i).current());
    injected_->most_current = std::max(injected_->most_current, current);
    if (current > 0) injected_->last_current = injected_->tick;
    if (can_.state(i).target_permille != 0) injected_->last_command = injected_->tick;
  }
  return reading;
}

bool TestBench::off() EBAC_RT {
  for (std::size_t i = 0; i < axes(); ++i) {
    const can::DriveState state = drive(i).state();
    const bool on =
        state == can::DriveState::kOperationEnabled || state == can::DriveState::kQuickStopActive;
    if (on || drive(i).current() != 0) return false;
  }
  return true;
}

}  // namespace ebac::faults
