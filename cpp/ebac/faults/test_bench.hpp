#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "ebac/faults/faulty_bus.hpp"
#include "ebac/faults/faulty_parts.hpp"
#include "ebac/simulated_drives/can_test_bench.hpp"

namespace ebac::faults {

/// Test bench: a plant, its drives and a bus with injected faults, in virtual time; the drives
/// monitor the loop as the loop monitors them. Not movable: its parts refer to each other.
class TestBench {
 public:
  using Other = can::JoystickOnBus<FaultyPlant>;
  using Can = can::CanopenDevice<FaultyBus, can::OnOtherSide<Other>>;

  TestBench(const CaseSetup& made, InjectedFault& injected, Referee& referee);
  TestBench(const TestBench&) = delete;
  TestBench& operator=(const TestBench&) = delete;
  TestBench(TestBench&&) = delete;
  TestBench& operator=(TestBench&&) = delete;
  ~TestBench() = default;

  /// Faults of the drives begin and end here.
  Reading exchange(const Command& command) EBAC_RT;

  Can& can() EBAC_RT { return can_; }
  can::SimulatedDrive& drive(std::size_t axis) EBAC_RT { return other_.joystick().drive(axis); }
  std::size_t axes() EBAC_RT { return other_.joystick().axes(); }
  const SimulatedDevice& plant() const EBAC_RT { return other_.plant().simulated(); }
  /// No motor has current, and none may get any.
  bool off() const EBAC_RT { return other_.joystick().off(); }
  /// Asks for current, if the fault is one of a loop that does so before its drives are enabled.
  Command pressed(const Command& command) const EBAC_RT;
  /// What a loop hears that does not heed its device.
  Reading heeded(Reading reading) const EBAC_RT;

 private:
  void spoil_drive() EBAC_RT;
  void spoil_wire() EBAC_RT;
  void intrude() EBAC_RT;
  void spoil_sensor(Reading& reading) EBAC_RT;
  void watch(double elapsed) EBAC_RT;

  InjectedFault* injected_;
  Referee* referee_;
  can::Wiring wiring_;
  can::VirtualBus bus_;
  Other other_;
  FaultyBus near_;
  Can can_;
  double force_age_ = 0;  // s
};

/// The test bench as the loop's device.
class FaultyDevice {
 public:
  explicit FaultyDevice(TestBench& bench) EBAC_RT : bench_(&bench) {}

  Reading exchange(const Command& command) EBAC_RT {
    return bench_->heeded(bench_->exchange(bench_->pressed(command)));
  }
  void enable() EBAC_RT { bench_->can().enable(); }
  void disable() EBAC_RT { bench_->can().disable(); }
  void stop() EBAC_RT { bench_->can().stop(); }
  bool running() const EBAC_RT { return bench_->can().running(); }
  auto parts() const EBAC_RT { return std::tie(bench_->plant(), std::as_const(bench_->can())); }

 private:
  TestBench* bench_;
};

static_assert(Device<FaultyDevice>);

}  // namespace ebac::faults
