#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <variant>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

/// The map between joints [rad, N m] and the handle [m, N]. A kinematics gives `axes`, `travel`, `stops`,
/// `forward`, `inverse`, `jacobian`, `weight`; the free functions below derive the rest.
namespace ebac {

/// Joints or ports of one device; entries beyond the axes in use are zero.
using Axes = Eigen::Vector3d;
using Jacobian = Eigen::Matrix3d;

static_assert(Axes::SizeAtCompileTime == kMaxAxes);

/// n independent axes: x = R q. The device of eq. (6).
struct Linear {
  int axes = 1;
  double radius = 0.1;                  // m
  double limit = std::numbers::pi / 6;  // rad

  Axes forward(const Axes& q) const EBAC_RT { return radius * q; }
  Axes inverse(const Axes& x) const EBAC_RT { return x / radius; }
  Jacobian jacobian(const Axes&) const EBAC_RT { return radius * Jacobian::Identity(); }
  Axes weight(const Axes&, double newton) const EBAC_RT { return Axes::Constant(newton * radius); }
  Axes travel() const EBAC_RT { return Axes::Constant(radius); }
  Axes stops() const EBAC_RT { return Axes::Constant(limit); }

  static constexpr auto fields() {
    using F = Field<Linear>;
    return std::array{
        F{"axes", &Linear::axes, "1", "number of independent axes", 1, kMaxAxes},
        F{"radius", &Linear::radius, "m", "lever radius: travel per joint angle", 1e-4, 10},
        F{"limit", &Linear::limit, "rad", "largest joint angle either way", 1e-3, 1e3},
    };
  }
};

/// The paper's joystick: a lever of radius R on two crossed axes. q1 turns it about the base's y
/// axis and moves the handle along x; q2 turns it about the moved x axis and moves the handle along
/// y. The handle lies on a sphere: x = R sin q1 cos q2, y = R sin q2, z = R cos q1 cos q2 (upright:
/// q = 0).
struct Gimbal {
  static constexpr int kAxes = 2;
  double radius = 0.1;                  // m
  double limit = std::numbers::pi / 6;  // rad, eq. (11)

  Axes forward(const Axes& q) const EBAC_RT {
    return {radius * std::sin(q[0]) * std::cos(q[1]), radius * std::sin(q[1]), 0};
  }

  /// Unique for |q| < 90 deg; a point outside the sphere gives the nearest on its rim.
  Axes inverse(const Axes& x) const EBAC_RT {
    const double q2 = std::asin(std::clamp(x[1] / radius, -1.0, 1.0));
    const double reach = radius * std::cos(q2);
    const double q1 = reach > 0 ? std::asin(std::clamp(x[0] / reach, -1.0, 1.0)) : 0.0;
    return {q1, q2, 0};
  }

  double height(const Axes& q) const EBAC_RT { return radius * std::cos(q[0]) * std::cos(q[1]); }

  Jacobian jacobian(const Axes& q) const EBAC_RT {
    Jacobian j = Jacobian::Zero();
    j(0, 0) = radius * std::cos(q[0]) * std::cos(q[1]);
    j(0, 1) = -radius * std::sin(q[0]) * std::sin(q[1]);
    j(1, 1) = radius * std::cos(q[1]);
    return j;
  }

  Axes weight(const Axes& q, double newton) const EBAC_RT {
    return newton * radius *
           Axes{std::sin(q[0]) * std::cos(q[1]), std::cos(q[0]) * std::sin(q[1]), 0};
  }
  Axes travel() const EBAC_RT { return Axes::Constant(radius); }
  Axes stops() const EBAC_RT { return Axes::Constant(limit); }

  static constexpr auto fields() {
    using F = Field<Gimbal>;
    return std::array{
        F{"radius", &Gimbal::radius, "m", "lever radius (paper, IV.A)", 1e-4, 10},
        F{"limit", &Gimbal::limit, "rad", "largest angle of each joint either way, eq. (11)", 1e-3,
          1.5},
    };
  }
};

/// A gimbal whose lever slides through its joints: the third joint is the drum that pulls it, outwards for
/// +q3. The lever is R + slide_radius q3 long, the rest is the gimbal's; the handle moves in space, and the
/// third port is its height above where it rests.
struct SlidingGimbal {
  static constexpr int kAxes = 3;
  double radius = 0.1;                  // m, with the slide in its middle
  double limit = std::numbers::pi / 6;  // rad, of the first two joints
  double slide_radius = 0.1;            // m
  double slide_limit = 0.04;            // m

  Gimbal gimbal(const Axes& q) const EBAC_RT { return {radius + slide_radius * q[2], limit}; }

  Axes forward(const Axes& q) const EBAC_RT {
    const Gimbal now = gimbal(q);
    Axes x = now.forward(q);
    x[2] = now.height(q) - radius;
    return x;
  }

  /// Unique above the joints, where every pose within the limits is.
  Axes inverse(const Axes& x) const EBAC_RT {
    const double aside = std::hypot(x[0], x[2] + radius);
    return {std::atan2(x[0], x[2] + radius), std::atan2(x[1], aside),
            (std::hypot(x[1], aside) - radius) / slide_radius};
  }

  Jacobian jacobian(const Axes& q) const EBAC_RT {
    const Gimbal now = gimbal(q);
    Jacobian j = now.jacobian(q);
    j.row(2) = -now.weight(q, 1);  // the height falls as the weight turns
    j.col(2) = slide_radius * outwards(q);
    return j;
  }

  Axes weight(const Axes& q, double newton) const EBAC_RT {
    Axes tau = gimbal(q).weight(q, newton);
    tau[2] = -newton * slide_radius * std::cos(q[0]) * std::cos(q[1]);
    return tau;
  }
  Axes travel() const EBAC_RT { return {radius, radius, slide_radius}; }
  Axes stops() const EBAC_RT { return {limit, limit, slide_limit / slide_radius}; }
  /// Longest lever over that in the middle.
  double stretch() const EBAC_RT { return 1 + slide_limit / radius; }

  /// Direction of the lever.
  static Axes outwards(const Axes& q) EBAC_RT {
    const Gimbal unit{.radius = 1};
    Axes out = unit.forward(q);
    out[2] = unit.height(q);
    return out;
  }

  static constexpr auto fields() {
    using F = Field<SlidingGimbal>;
    return std::array{
        F{"radius", &SlidingGimbal::radius, "m", "lever radius with the slide in its middle", 1e-4,
          10},
        F{"limit", &SlidingGimbal::limit, "rad", "largest angle of the first two joints either way",
          1e-3, 1.5},
        F{"slide_radius", &SlidingGimbal::slide_radius, "m",
          "way of the slide per angle of its joint, the third; half to twice the lever radius",
          1e-4, 10},
        F{"slide_limit", &SlidingGimbal::slide_limit, "m",
          "largest way of the slide either way, at most half of the lever radius", 1e-4, 5},
    };
  }
};

using Kinematics = std::variant<Linear, Gimbal, SlidingGimbal>;

inline int axes(const Linear& linear) EBAC_RT { return linear.axes; }
inline int axes(const Gimbal&) EBAC_RT { return Gimbal::kAxes; }
inline int axes(const SlidingGimbal&) EBAC_RT { return SlidingGimbal::kAxes; }

int axes(const Kinematics& kinematics) EBAC_RT;
double radius(const Kinematics& kinematics) EBAC_RT;
/// Way of the handle per angle of each joint, at rest in the middle [m].
Axes travel(const Kinematics& kinematics) EBAC_RT;
/// Largest angle of each joint either way [rad].
Axes stops(const Kinematics& kinematics) EBAC_RT;
/// Longest lever over that in the middle.
double stretch(const Kinematics& kinematics) EBAC_RT;
Axes forward(const Kinematics& kinematics, const Axes& q) EBAC_RT;
Axes inverse(const Kinematics& kinematics, const Axes& x) EBAC_RT;
Jacobian jacobian(const Kinematics& kinematics, const Axes& q) EBAC_RT;
/// Joint torque that shows the force `f` at the handle: tau = J(q)^T f.
Axes transpose(const Kinematics& kinematics, const Axes& q, const Axes& f) EBAC_RT;
/// Joint torque along +q of a weight [N] at the handle: along +x for Linear, down for a gimbal.
Axes weight(const Kinematics& kinematics, const Axes& q, double newton) EBAC_RT;
/// Whether every joint lies within its limit.
bool within_limits(const Kinematics& kinematics, const Axes& q) EBAC_RT;

}  // namespace ebac
