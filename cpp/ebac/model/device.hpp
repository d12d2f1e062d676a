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

/// One haptic device, part by part; motor, drive, encoder and capstan of every axis are alike. The default is the reference device: one straight axis of 0.25
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

  // Of one axis at rest in the middle, the first if not told otherwise.

  /// Way of the handle per joint angle [m].
  double travel(int axis = 0) const EBAC_RT { return ebac::travel(kinematics)[axis]; }
  /// Handle force per motor torque [1/m].
  double force_per_torque(int axis = 0) const EBAC_RT { return capstan.ratio() / travel(axis); }
  double force(double current, int axis = 0) const EBAC_RT {
    return motor.torque(current) * force_per_torque(axis);
  }
  double continuous_force(int axis = 0) const EBAC_RT {
    return motor.rated_torque * force_per_torque(axis);
  }
  double peak_force(int axis = 0) const EBAC_RT { return force(drive.peak_current(motor), axis); }

  /// One encoder count at the handle [m].
  double count(int axis = 0) const EBAC_RT {
    return encoder.count() / capstan.ratio() * travel(axis);
  }

  /// Rotor inertia as mass at the handle [kg]; the square of force_per_torque times the inertia.
  double reflected_mass(int axis = 0) const EBAC_RT {
    return motor.rotor_inertia * force_per_torque(axis) * force_per_torque(axis);
  }
  double mass(int axis = 0) const EBAC_RT { return mechanics.handle_mass + reflected_mass(axis); }

  /// First resonance of a cable that gives: the rotor against a handle that is held [Hz]; 0 without.
  double resonance() const EBAC_RT {
    if (mechanics.cable_stiffness == 0) return 0;
    const double w = std::sqrt(mechanics.cable_stiffness / std::max(1e-6, reflected_mass()));
    return w / (2 * std::numbers::pi);
  }

  /// What holds on every axis and at every length of the lever: a longer one moves the handle farther for a
  /// count and feels less of what is in the joints, their damping by the square.
  DeviceFacts facts() const EBAC_RT {
    const double longest = stretch(kinematics);
    const int last = axes() - 1;
    const double rotor = std::min(reflected_mass() / (longest * longest), reflected_mass(last));
    return {.damping = compensation.damping_left(mechanics.damping / (longest * longest),
                                                 mechanics.coulomb / longest),
            .mass = compensation.mass_left(mechanics.handle_mass + rotor),
            .count = std::max(count() * longest, count(last)),
            .current_lag = drive.current_lag,
            .peak_force = std::min(peak_force() / longest, peak_force(last)),
            .resonance = resonance(),
            .force_noise = std::max(DeviceFacts{}.force_noise, sensor.noise),
            .force_sensor = sensor.fitted};
  }
};

/// Throws std::invalid_argument where two parts do not fit each other.
void check_device(const DeviceModel& device);

}  // namespace ebac
