#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "ebac/core/fields.hpp"
#include "ebac/model/kinematics.hpp"

namespace ebac::world {

/// Where a body is at an instant, and how fast.
struct BodyPose {
  Axes at = Axes::Zero();  // m
  Jacobian turn = Jacobian::Identity();
  Axes velocity = Axes::Zero();  // m/s, of its origin
  Axes rate = Axes::Zero();      // rad/s

  Axes into(const Axes& x) const EBAC_RT { return turn.transpose() * (x - at); }
  /// Of the body's material at a point of space.
  Axes velocity_at(const Axes& x) const EBAC_RT { return velocity + rate.cross(x - at); }
};

/// A body that swings to and fro along a direction and turns about another.
struct Swing {
  double amplitude_x = 0;  // m
  double amplitude_y = 0;  // m
  double amplitude_z = 0;  // m
  double frequency = 0.5;  // Hz
  double phase = 0;        // rad
  double turn_x = 0;       // rad/s
  double turn_y = 0;       // rad/s
  double turn_z = 0;       // rad/s

  bool still() const EBAC_RT {
    return amplitude_x == 0 && amplitude_y == 0 && amplitude_z == 0 && turn_x == 0 && turn_y == 0 &&
           turn_z == 0;
  }

  BodyPose at(double t) const EBAC_RT {
    const double w = 2 * std::numbers::pi * frequency;
    const Axes amplitude{amplitude_x, amplitude_y, amplitude_z};
    const Axes rate{turn_x, turn_y, turn_z};
    const double speed = rate.norm();
    BodyPose pose{.at = std::sin(w * t + phase) * amplitude,
                  .velocity = w * std::cos(w * t + phase) * amplitude,
                  .rate = rate};
    if (speed > 0) pose.turn = Eigen::AngleAxisd(speed * t, rate / speed).toRotationMatrix();
    return pose;
  }

  static constexpr auto fields() {
    using F = Field<Swing>;
    return std::array{
        F{"amplitude_x", &Swing::amplitude_x, "m", "of the swing along x", -1, 1},
        F{"amplitude_y", &Swing::amplitude_y, "m", "of the swing along y", -1, 1},
        F{"amplitude_z", &Swing::amplitude_z, "m", "of the swing along z", -1, 1},
        F{"frequency", &Swing::frequency, "Hz", "of the swing", 0, 100},
        F{"phase", &Swing::phase, "rad", "of the swing at the beginning", -6.3, 6.3},
        F{"turn_x", &Swing::turn_x, "rad/s", "turning about x", -100, 100},
        F{"turn_y", &Swing::turn_y, "rad/s", "turning about y", -100, 100},
        F{"turn_z", &Swing::turn_z, "rad/s", "turning about z", -100, 100},
    };
  }
};

}  // namespace ebac::world
