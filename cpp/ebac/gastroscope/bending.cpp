#include "ebac/gastroscope/bending.hpp"

namespace ebac::gastroscope {

namespace {

/// (1 - cos t)/t^2, sin t / t, and their derivatives over t, free of cancellation near zero.
struct Arc {
  explicit Arc(double t) EBAC_RT : t2(t* t) {
    constexpr double kSmall = 0.1;  // rad; below, three terms leave 1e-12
    if (t < kSmall) {
      aside = 0.5 - t2 * (1.0 / 24 - t2 * (1.0 / 720 - t2 / 40320));
      ahead = 1 - t2 * (1.0 / 6 - t2 * (1.0 / 120 - t2 / 5040));
      aside_slope = -1.0 / 12 + t2 * (1.0 / 180 - t2 * (1.0 / 6720 - t2 / 453600));
      ahead_slope = -1.0 / 3 + t2 * (1.0 / 30 - t2 * (1.0 / 840 - t2 / 45360));
      cosine = 1 - t2 * aside;
    } else {
      const double sine = std::sin(t);
      cosine = std::cos(t);
      aside = (1 - cosine) / t2;
      ahead = sine / t;
      aside_slope = (ahead - 2 * aside) / t2;
      ahead_slope = (cosine - ahead) / t2;
    }
  }
  double t2;
  double aside = 0, ahead = 0, aside_slope = 0, ahead_slope = 0, cosine = 1;
};

}  // namespace

SectionPoint point_of(const Bend& bend, double length, double u) EBAC_RT {
  const double a = u * bend.x, b = u * bend.y;
  const Arc arc(std::hypot(a, b));
  const double l = u * length;
  const Vec ahead{arc.ahead * a, arc.ahead * b, arc.cosine};
  return {{l * arc.aside * a, l * arc.aside * b, l * arc.ahead},
          // Rodrigues: about the axis that is square to the direction of bending
          {{1 - arc.aside * a * a, -arc.aside * a * b, -ahead.x},
           {-arc.aside * a * b, 1 - arc.aside * b * b, -ahead.y},
           ahead}};
}

SectionPoint camera_of(const Bend& bend, double length, double tip) EBAC_RT {
  SectionPoint end = point_of(bend, length, 1);
  end.at += tip * end.camera.z;
  return end;
}

CameraJacobian jacobian_of(const Bend& bend, double length, double tip) EBAC_RT {
  const Arc arc(std::hypot(bend.x, bend.y));
  const Vec at = camera_of(bend, length, tip).at;
  const double reach = length * arc.aside + tip * arc.ahead;
  const double slope = length * arc.aside_slope + tip * arc.ahead_slope;
  const double ahead = length * arc.ahead_slope - tip * arc.ahead;
  const auto along = [&](double own, double other, bool right) EBAC_RT {
    const double same = reach + slope * own * own, across = slope * own * other;
    return right ? Vec{same, across, ahead * own} : Vec{across, same, ahead * own};
  };
  return {Vec{0, 0, 1}, Vec{-at.y, at.x, 0}, along(bend.x, bend.y, true),
          along(bend.y, bend.x, false)};
}

}  // namespace ebac::gastroscope
