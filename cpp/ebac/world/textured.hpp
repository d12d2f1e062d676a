#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "ebac/core/fields.hpp"
#include "ebac/world/combined.hpp"

namespace ebac::world {

/// Waves on a surface, equal in all directions: amplitude (sin kx + sin ky + sin kz) / 3 of the place.
struct Texture {
  double amplitude = 0.2e-3;  // m
  double wavelength = 5e-3;   // m

  /// Height of the surface above the smooth one [m], at most `amplitude`, and how it changes with the place [1].
  struct Height {
    double h;
    Axes slope;
  };
  Height at(const Axes& x) const EBAC_RT {
    const double k = 2 * std::numbers::pi / wavelength;
    const double share = amplitude / 3;
    const auto phase = (k * x).array();
    return {share * phase.sin().sum(), share * k * phase.cos().matrix()};
  }

  static constexpr auto fields() {
    using F = Field<Texture>;
    return std::array{
        F{"amplitude", &Texture::amplitude, "m", "of the waves, above and below the smooth surface",
          0, 0.1},
        F{"wavelength", &Texture::wavelength, "m", "along each axis", 1e-4, 1},
    };
  }
};

/// A solid with a texture.
///
/// Its distance is exact to first order; outside it may exceed the true one by half the amplitude.
class Textured final : public Solid {
 public:
  Textured(SolidPtr solid, const Texture& texture) : solid_(std::move(solid)), texture_(texture) {}

  Distance distance(const Axes& x) const EBAC_RT override {
    const Distance smooth = solid_->distance(x);
    if (smooth.d > 2 * texture_.amplitude) return {smooth.d - texture_.amplitude, smooth.out};
    const Texture::Height wave = texture_.at(x);
    const Axes uphill = smooth.out - wave.slope;
    const double steepness = uphill.norm();  // the waves are flatter than 30 degrees
    // Height over steepness is the distance near the surface; deep inside it would stretch the depth.
    const double near = std::max(0.0, 1 - std::abs(smooth.d) / (2 * texture_.amplitude));
    return {(smooth.d - wave.h) / (1 + near * (steepness - 1)), uphill / steepness};
  }

 private:
  SolidPtr solid_;
  Texture texture_;
};

}  // namespace ebac::world
