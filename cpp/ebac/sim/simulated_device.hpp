#pragma once

#include <array>
#include <cmath>
#include <variant>

#include "ebac/core/concepts.hpp"
#include "ebac/model/exact_plant.hpp"
#include "ebac/model/stepped_plant.hpp"
#include "ebac/sim/setup.hpp"

namespace ebac {

/// Takes amperes, returns encoder counts one tick later: the machine's place on the desk. Everything behind the
/// counts (estimation, kinematics, limits, units, latency) is the same code as on the machine.
class SimulatedDevice {
 public:
  using State = AxisTruth;

  explicit SimulatedDevice(const Setup& setup)
      : device_(setup.device),
        plant_(make_plant(setup)),
        random_(setup.seed),
        tick_(setup.timing.dt),
        delay_(setup.timing.delay) {}

  Reading exchange(const Command& command) EBAC_RT {
    if (command.elapsed > 0) {
      const Axes current = delayed(command);
      const auto quanta = static_cast<std::int64_t>(
          std::llround(command.elapsed / tick_ * static_cast<double>(kQuanta)));
      std::visit([&](auto& plant) EBAC_RT { plant.advance(current, t_, quanta); }, plant_);
      t_ += command.elapsed;
      for (std::size_t i = 0; i < kMaxAxes; ++i) applied_[i] = current[static_cast<Eigen::Index>(i)];
    }
    return std::visit([&](const auto& plant) EBAC_RT { return latch(plant); }, plant_);
  }

  const State& state(std::size_t axis) const EBAC_RT {
    return std::visit([&](const auto& plant) EBAC_RT -> const State& { return plant.truth(axis); }, plant_);
  }

 private:
  using Plant = std::variant<ExactPlant, SteppedPlant>;

  static Plant make_plant(const Setup& s) {
    if (ExactPlant::covers(s.device)) return ExactPlant(s.device, s.hand, s.timing.dt);
    return SteppedPlant(s.device, s.hand, s.timing.dt);
  }

  /// What the drive sets during the next interval: the command of `delay - 1` exchanges ago.
  Axes delayed(const Command& command) EBAC_RT {
    const double peak = device_.drive.peak_current(device_.motor);
    Axes asked;
    for (std::size_t i = 0; i < kMaxAxes; ++i) {
      double current = std::clamp(command.current[i], -peak, peak);
      if (device_.drive.permille) current = whole_permille(current);
      asked[static_cast<Eigen::Index>(i)] = current;
    }
    if (delay_ == 0) return asked;
    const Axes now = queue_[head_];
    queue_[head_] = asked;
    head_ = (head_ + 1) % static_cast<std::size_t>(delay_);
    return now;
  }

  double whole_permille(double current) const EBAC_RT {
    const double one = device_.motor.current(device_.motor.rated_torque) / 1000;
    return one * std::round(current / one);
  }

  template <class P>
  Reading latch(const P& plant) EBAC_RT {
    Reading reading;
    for (std::size_t i = 0; i < static_cast<std::size_t>(device_.axes()); ++i) {
      const double angle = plant.motor_angle(i);
      if (!std::isfinite(angle)) {
        reading.fault = Fault::kDevice;
        continue;
      }
      reading.counts[i] = device_.encoder.read(angle);
      reading.current_applied[i] = applied_[i];
      reading.force[i] = device_.sensor.read(plant.truth(i).f_sensor, random_);
    }
    return reading;
  }

  DeviceModel device_;
  Plant plant_;
  Noise random_;
  double tick_;
  int delay_;
  double t_ = 0;
  std::array<Axes, 8> queue_ = [] {
    std::array<Axes, 8> all;
    all.fill(Axes::Zero());
    return all;
  }();
  std::size_t head_ = 0;
  std::array<double, kMaxAxes> applied_{};
};

static_assert(Device<SimulatedDevice>);

}  // namespace ebac
