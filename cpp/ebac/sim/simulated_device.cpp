#include "ebac/sim/simulated_device.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>

namespace ebac {

/// Sets the currents of the next interval: the command of `delay` exchanges ago.
void SimulatedDevice::drive(const Command& command, std::size_t axes) EBAC_RT {
  for (std::size_t i = 0; i < axes; ++i) {
    double current = std::clamp(command.current[i], -peak_current_, peak_current_);
    if (device_.drive.permille) current = whole_permille(current);
    if (delay_ > 0) std::swap(current, queue_[head_][i]);
    applied_[static_cast<Eigen::Index>(i)] = current;
  }
  if (++head_ >= delay_) head_ = 0;
}

std::int64_t SimulatedDevice::quanta(double seconds) const EBAC_RT {
  return seconds == tick_ ? kQuanta : std::llround(seconds / tick_ * static_cast<double>(kQuanta));
}

double SimulatedDevice::whole_permille(double current) const EBAC_RT {
  const double one = device_.motor.current(device_.motor.rated_torque) / 1000;
  return one * (std::round(current / one) + 0.0);  // a whole number has no negative zero
}

/// The currents that would give an exact motor its torque over the next interval: offset and noise of the drive are added,
/// ripple and cogging are those of the angle at its beginning, from a place of the rotor that the seed draws.
template <class P>
Axes SimulatedDevice::torque_currents(const P& plant, std::size_t axes) EBAC_RT {
  const Motor& motor = device_.motor;
  const Drive& drive = device_.drive;
  Axes currents = applied_;
  for (std::size_t i = 0; i < axes; ++i) {
    double& current = currents[static_cast<Eigen::Index>(i)];
    current += drive.current_offset;
    if (drive.current_noise > 0) current += drive.current_noise * random_.normal();
    current = motor.current(motor.uneven_torque(current, plant.motor_angle(i) + rotor_[i]));
  }
  return currents;
}

/// The force, by the records of a sensor that is not prompt.
template <class P>
void SimulatedDevice::feel(const P& plant, Reading& reading) EBAC_RT {
  ForceRecords::Forces force{};
  for (std::size_t i = 0; i < axes_; ++i) force[i] = plant.truth(i).f_sensor;
  records_.tick(device_.sensor, t_, force, axes_, [&](std::size_t i, double at) EBAC_RT {
    shown_[i] = device_.sensor.read(at, random_);
  });
  reading.force = shown_;
  reading.force_age = records_.age();
}

template <class P>
Reading SimulatedDevice::latch(const P& plant, std::size_t axes) EBAC_RT {
  Reading reading = blank_;
  if (!prompt_) feel(plant, reading);
  for (std::size_t i = 0; i < axes; ++i) {
    const double angle = plant.motor_angle(i);
    if (!std::isfinite(angle)) {
      reading.fault = Fault::kDevice;
      continue;
    }
    reading.counts[i] = device_.encoder.read(angle + phase_[i]);
    reading.current_applied[i] = applied_[static_cast<Eigen::Index>(i)];
    if (prompt_) reading.force[i] = device_.sensor.read(plant.truth(i).f_sensor, random_);
    if (std::abs(reading.force[i]) >= device_.sensor.range) {
      reading.force_status = SensorStatus::kSaturated;
    }
  }
  if (!prompt_ && device_.sensor.disconnects && device_.sensor.stopped(t_)) {
    reading.force_status = SensorStatus::kDisconnected;
  }
  return reading;
}

template <class P>
Reading SimulatedDevice::step(P& plant, const Command& command, std::size_t axes) EBAC_RT {
  if (command.elapsed > 0) {
    drive(command, axes);
    const auto advance = [&](const Axes& currents) EBAC_RT {
      if constexpr (std::same_as<P, ExactPlant>) {
        plant.advance(currents, t_, quanta(command.elapsed), axes);
      } else {
        plant.advance(currents, t_, quanta(command.elapsed));
      }
    };
    if (exact_) {
      advance(applied_);
    } else {
      advance(torque_currents(plant, axes));
    }
    t_ += command.elapsed;
  }
  return latch(plant, axes);
}

EBAC_ONE_FUNCTION Reading SimulatedDevice::exchange(const Command& command) EBAC_RT {
  if (auto* stepped = std::get_if<SteppedPlant>(&plant_)) {
    return step(*stepped, command, axes_);
  }
  auto& exact = *std::get_if<ExactPlant>(&plant_);
  // The usual device: its code has no loops.
  return axes_ == 1 ? step(exact, command, 1) : step(exact, command, axes_);
}

}  // namespace ebac
