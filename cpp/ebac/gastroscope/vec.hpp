#pragma once

#include <cmath>

#include "ebac/core/realtime.hpp"

/// Three numbers, and what the gastroscope needs of them: plain, so that its headers compile fast.
namespace ebac::gastroscope {

struct Vec {
  double x = 0, y = 0, z = 0;

  Vec& operator+=(const Vec& o) EBAC_RT { return *this = {x + o.x, y + o.y, z + o.z}; }
  Vec& operator-=(const Vec& o) EBAC_RT { return *this = {x - o.x, y - o.y, z - o.z}; }
};

inline Vec operator+(Vec a, const Vec& b) EBAC_RT { return a += b; }
inline Vec operator-(Vec a, const Vec& b) EBAC_RT { return a -= b; }
inline Vec operator*(double s, const Vec& a) EBAC_RT { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(const Vec& a, const Vec& b) EBAC_RT { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(const Vec& a, const Vec& b) EBAC_RT {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(const Vec& a) EBAC_RT { return std::sqrt(dot(a, a)); }
/// The direction of `a`; `other` where it has none.
inline Vec unit(const Vec& a, const Vec& other) EBAC_RT {
  const double length = norm(a);
  return length > 0 ? (1 / length) * a : other;
}

/// Right-handed axes of a camera: right, down, ahead.
struct Frame {
  Vec x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

  /// Own coordinates to those of the world.
  Vec out(const Vec& own) const EBAC_RT { return own.x * x + own.y * y + own.z * z; }
  /// And back.
  Vec in(const Vec& world) const EBAC_RT { return {dot(x, world), dot(y, world), dot(z, world)}; }
};

/// The frame turned by the shortest way so that it looks along `ahead`, a unit vector.
inline Frame look_along(const Frame& frame, const Vec& ahead) EBAC_RT {
  Vec x = frame.x - dot(frame.x, ahead) * ahead;
  x = unit(x, cross(frame.y, ahead));
  return {x, cross(ahead, x), ahead};
}

/// The frame turned about its own z axis by `angle` [rad].
inline Frame rolled(const Frame& frame, double angle) EBAC_RT {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * frame.x + s * frame.y, c * frame.y - s * frame.x, frame.z};
}

}  // namespace ebac::gastroscope
