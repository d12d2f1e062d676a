#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ebac/core/device_facts.hpp"
#include "ebac/model/capstan.hpp"
#include "ebac/model/compensation.hpp"
#include "ebac/model/encoder.hpp"
#include "ebac/model/force_sensor.hpp"
#include "ebac/model/kinematics.hpp"
#include "ebac/model/mechanics.hpp"
#include "ebac/model/motor.hpp"
#include "ebac/model/velocity.hpp"

namespace ebac {

/// One haptic device, part by part. The default is the reference device: one straight axis of 0.25
/// kg and 2 N s/m, built from the paper's motor, encoder and capstan.
struct DeviceModel {
  Kinematics kinematics{};
  Motor motor{};
  Drive drive{};
  Encoder encoder{};
  Capstan capstan{};
  Mechanics mechanics{};
  ForceSensor sensor{};
  Velocity velocity{};
  Compensation compensation{};

  int axes() const EBAC_RT { return ebac::axes(kinematics); }
  double radius() const EBAC_RT { return ebac::radius(kinematics); }

  /// Handle force per motor torque, at rest in the middle [1/m].
  double force_per_torque() const EBAC_RT { return capstan.ratio() / radius(); }
  double force(double current) const EBAC_RT { return motor.torque(current) * force_per_torque(); }
  double continuous_force() const EBAC_RT { return motor.rated_torque * force_per_torque(); }
  double peak_force() const EBAC_RT { return force(drive.peak_current(motor)); }

  /// One encoder count at the handle [m].
  double count() const EBAC_RT { return encoder.count() / capstan.ratio() * radius(); }

  /// Rotor inertia as mass at the handle [kg]; the square of force_per_torque times the inertia.
  double reflected_mass() const EBAC_RT {
    return motor.rotor_inertia * force_per_torque() * force_per_torque();
  }
  double mass() const EBAC_RT { return mechanics.handle_mass + reflected_mass(); }

  /// First resonance of a cable that gives: the rotor against a handle that is held [Hz]; 0 without.
  double resonance() const EBAC_RT {
    if (mechanics.cable_stiffness == 0) return 0;
    const double w = std::sqrt(mechanics.cable_stiffness / std::max(1e-6, reflected_mass()));
    return w / (2 * std::numbers::pi);
  }

  DeviceFacts facts() const EBAC_RT {
    return {.damping = compensation.damping_left(mechanics.damping, mechanics.coulomb),
            .mass = compensation.mass_left(mass()),
            .count = count(),
            .current_lag = drive.current_lag,
            .peak_force = peak_force(),
            .resonance = resonance()};
  }
};

/// Throws std::invalid_argument where two parts do not fit each other.
void check_device(const DeviceModel& device);

}  // namespace ebac
