#pragma once

#include <array>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac {

/// A cable from the motor's drum to a sector on the lever.
struct Capstan {
  double drum_radius = 0.005;  // m
  double sector_radius = 0.1;  // m

  double ratio() const EBAC_RT { return sector_radius / drum_radius; }  // motor rad per joint rad

  static constexpr auto fields() {
    using F = Field<Capstan>;
    return std::array{
        F{"drum_radius", &Capstan::drum_radius, "m",
          "radius of the drum on the motor (paper, IV.D)", 1e-4, 1},
        F{"sector_radius", &Capstan::sector_radius, "m",
          "radius of the sector on the lever; 42.4 N at the handle needs it equal to the lever",
          1e-4, 10},
    };
  }
};

}  // namespace ebac
