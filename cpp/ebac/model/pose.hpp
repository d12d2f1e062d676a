#pragma once

#include "ebac/model/kinematics.hpp"

namespace ebac {

/// Pose of a lever, and the effect of its geometry on a mass of 1 kg at the handle.
struct Pose {
  Axes x;         // m, handle
  Jacobian j;     // m
  Axes drift;     // m/s^2, J' dq: acceleration of the port at constant joint rates
  Axes inertia;   // m^2, diagonal of the mass matrix
  Axes coriolis;  // m^2/s^2, torque due to the rates alone
  Axes weight;    // m, joint torque per newton of weight
};

Pose pose(const Kinematics& kinematics, const Axes& q, const Axes& dq) EBAC_RT;

}  // namespace ebac
