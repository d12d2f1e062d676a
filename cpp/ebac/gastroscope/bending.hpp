#pragma once

#include <array>

#include "ebac/gastroscope/vec.hpp"

/// Kinematics of the bending section: an arc of constant curvature, and a stiff tip behind it
/// (Webster and Jones, Int. J. Robotics Research 29, 2010, 1661-1683).
namespace ebac::gastroscope {

/// Bending angles of the whole section [rad], towards the camera's right and down.
struct Bend {
  double x = 0;
  double y = 0;
};

/// A place on the section: at the share `u` of its length, or at the end of the stiff tip.
struct SectionPoint {
  Vec at;        // m, in the frame of its base
  Frame camera;  // in the frame of its base
};

/// Where the share `u` of the section of `length` [m] is.
SectionPoint point_of(const Bend& bend, double length, double u) EBAC_RT;

/// The camera, `tip` [m] ahead of the section's end.
SectionPoint camera_of(const Bend& bend, double length, double tip) EBAC_RT;

/// How the camera moves with insertion [m/m], rotation, bending to the right and bending down
/// [m/rad], in the frame of the base.
using CameraJacobian = std::array<Vec, 4>;
CameraJacobian jacobian_of(const Bend& bend, double length, double tip) EBAC_RT;

}  // namespace ebac::gastroscope
