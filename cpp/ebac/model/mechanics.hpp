#pragma once

#include <array>

#include "ebac/core/fields.hpp"

namespace ebac {

/// Moving parts, referred to the handle; every axis of a device is built alike.
///
/// Rigid and without Stribeck friction the handle is one mass and the plant is exact between
/// events. A cable of finite stiffness or a backlash gives the rotor its own coordinate.
struct Mechanics {
  double handle_mass = 0.114;    // kg
  double damping = 2.0;          // N s/m
  double coulomb = 0;            // N
  double breakaway = 0;          // N
  double stribeck_speed = 0.01;  // m/s
  double gravity = 0;            // m/s^2
  double cable_stiffness = 0;    // N/m
  double cable_damping = 2.0;    // N s/m
  double backlash = 0;           // m

  bool stribeck() const { return breakaway > coulomb; }
  bool compliant() const { return cable_stiffness > 0; }

  static constexpr auto fields() {
    using F = Field<Mechanics>;
    return std::array{
        F{"handle_mass", &Mechanics::handle_mass, "kg",
          "mass of lever and handle, felt at the handle, without the rotor", 1e-3, 100},
        F{"damping", &Mechanics::damping, "N s/m", "viscous damping B_h of eq. (6)", 0, 500},
        F{"coulomb", &Mechanics::coulomb, "N", "Coulomb friction", 0, 100},
        F{"breakaway", &Mechanics::breakaway, "N",
          "friction at standstill when above coulomb (Stribeck)", 0, 100},
        F{"stribeck_speed", &Mechanics::stribeck_speed, "m/s",
          "speed over which friction falls from breakaway to coulomb", 1e-5, 10},
        F{"gravity", &Mechanics::gravity, "m/s^2",
          "Linear: pulls the handle along +x; Gimbal: pulls it down, so that upright is unstable",
          -100, 100},
        F{"cable_stiffness", &Mechanics::cable_stiffness, "N/m",
          "cable between rotor and lever; 0 is rigid", 0, 1e8},
        F{"cable_damping", &Mechanics::cable_damping, "N s/m", "damping inside the cable", 0, 1e4},
        F{"backlash", &Mechanics::backlash, "m",
          "play of the cable, end to end; needs cable_stiffness", 0, 0.1},
    };
  }
};

}  // namespace ebac
