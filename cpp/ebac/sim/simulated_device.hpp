#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>
#include <variant>

#include "ebac/core/device.hpp"
#include "ebac/model/exact_plant.hpp"
#include "ebac/model/force_records.hpp"
#include "ebac/model/stepped_plant.hpp"
#include "ebac/sim/setup.hpp"

namespace ebac {

/// Simulated device: takes currents in amperes, returns encoder counts one tick later. Everything
/// behind the counts (estimation, kinematics, limits, units, latency) is the same code as on the
/// machine.
class SimulatedDevice {
 public:
  using State = AxisTruth;
  static constexpr std::string_view kPrefix = "true.";
  static constexpr bool kQuick = true;

  explicit SimulatedDevice(const Setup& setup)
      : device_(setup.device),
        plant_(make_plant(setup)),
        random_(setup.seed),
        axes_(static_cast<std::size_t>(setup.device.axes())),
        peak_current_(setup.device.drive.peak_current(setup.device.motor)),
        exact_(is_exact(setup.device)),
        prompt_(setup.device.sensor.prompt()),
        records_(setup.device.sensor, setup.timing.dt),
        tick_(setup.timing.dt),
        delay_(static_cast<std::size_t>(setup.timing.delay)) {
    Noise chance(setup.seed, /*stream=*/2);
    for (double& phase : phase_) phase = 0.5 * device_.encoder.count() * chance.symmetric();
    for (double& rotor : rotor_) rotor = std::numbers::pi * chance.symmetric();
  }

  Reading exchange(const Command& command) EBAC_RT;

  /// From now on the hand wants to be at `target` [m], unless its path is a recorded one.
  void aim(std::size_t axis, double target) EBAC_RT {
    std::visit([&](auto& plant) EBAC_RT { plant.aim(axis, target); }, plant_);
  }

  const State& state(std::size_t axis) const EBAC_RT {
    return std::visit([&](const auto& plant) EBAC_RT -> const State& { return plant.truth(axis); },
                      plant_);
  }

 private:
  using Plant = std::variant<ExactPlant, SteppedPlant>;

  static Plant make_plant(const Setup& s) {
    if (ExactPlant::covers(s.device, s.hand)) return ExactPlant(s.device, s.hand, s.timing.dt);
    return SteppedPlant(s.device, s.hand, s.timing.dt);
  }

  /// Whether the motors turn the currents that are set into torque without an error.
  static bool is_exact(const DeviceModel& device) {
    return !device.motor.uneven() && device.drive.current_offset == 0 &&
           device.drive.current_noise == 0;
  }

  void drive(const Command& command, std::size_t axes) EBAC_RT;
  template <class P>
  Axes torque_currents(const P& plant, std::size_t axes) EBAC_RT;
  std::int64_t quanta(double seconds) const EBAC_RT;
  double whole_permille(double current) const EBAC_RT;
  template <class P>
  Reading latch(const P& plant, std::size_t axes) EBAC_RT;
  template <class P>
  Reading step(P& plant, const Command& command, std::size_t axes) EBAC_RT;
  template <class P>
  void feel(const P& plant, Reading& reading) EBAC_RT;

  Reading blank_{};  // copied: to clear one takes the processor a string instruction, 2 ns
  DeviceModel device_;
  Plant plant_;
  Noise random_;
  std::size_t axes_;
  double peak_current_;  // A
  bool exact_;           // motors and drives
  bool prompt_;          // the force sensor
  ForceRecords records_;
  std::array<double, kMaxAxes> shown_{};  // N, by the last record
  double tick_;
  std::size_t delay_;
  double t_ = 0;
  std::array<std::array<double, kMaxAxes>, kMaxDelay> queue_{};  // A, oldest at head_
  std::size_t head_ = 0;
  Axes applied_ = Axes::Zero();           // A, over the last interval
  std::array<double, kMaxAxes> phase_{};  // rad, of the motor within its first count
  std::array<double, kMaxAxes> rotor_{};  // rad, where its ripple begins
};

static_assert(Device<SimulatedDevice>);

}  // namespace ebac
