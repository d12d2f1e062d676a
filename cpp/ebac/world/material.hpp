#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

/// What a solid answers to being pressed in: a type with `press(depth, speed)`. None of them pulls.
namespace ebac::world {

/// A force along the normal and how it changes with depth.
struct Push {
  double force = 0;      // N
  double stiffness = 0;  // N/m
};

/// K x + B v, eq. (12): a spring, and with damping a Kelvin-Voigt body.
struct Elastic {
  double stiffness = 10e3;  // N/m
  double damping = 0;       // N s/m

  Push press(double depth, double speed) EBAC_RT {
    return {std::max(0.0, stiffness * depth + damping * speed), stiffness};
  }
  double stored(double depth) const EBAC_RT { return 0.5 * stiffness * depth * depth; }
  void reset() EBAC_RT {}

  static constexpr auto fields() {
    using F = Field<Elastic>;
    return std::array{
        F{"stiffness", &Elastic::stiffness, "N/m",
          "stiffness of the surface, force per depth: K of eq. (12)", 0, 1e7},
        F{"damping", &Elastic::damping, "N s/m",
          "damping of the surface, force per speed in contact: B of eq. (12)", 0, 1e4},
    };
  }
};

/// Soft tissue after Hunt and Crossley (1975): k x^n (1 + 3/2 a v). Its damper fades with the depth, so that contact
/// begins and ends without a jump.
struct HuntCrossley {
  double stiffness = 20e3;   // N/m^n
  double exponent = 1.5;     // n
  double dissipation = 0.5;  // s/m, a

  Push press(double depth, double speed) EBAC_RT {
    const double elastic = stiffness * std::pow(depth, exponent);
    return {std::max(0.0, elastic * (1 + 1.5 * dissipation * speed)),
            depth > 0 ? exponent * elastic / depth : 0.0};
  }
  double stored(double depth) const EBAC_RT {
    return stiffness * std::pow(depth, exponent + 1) / (exponent + 1);
  }
  void reset() EBAC_RT {}

  static constexpr auto fields() {
    using F = Field<HuntCrossley>;
    return std::array{
        F{"stiffness", &HuntCrossley::stiffness, "N/m^n", "k", 0, 1e9},
        F{"exponent", &HuntCrossley::exponent, "1", "n", 1, 3},
        F{"dissipation", &HuntCrossley::dissipation, "s/m", "a: loss at a speed, as a share", 0,
          100},
    };
  }
};

/// One layer of tissue.
struct Layer {
  double thickness = 5e-3;  // m
  double stiffness = 500;   // N/m
  double damping = 0;       // N s/m
  double puncture = 0;      // N; 0: never
  double cutting = 0;       // N, against motion, once it is punctured

  static constexpr auto fields() {
    using F = Field<Layer>;
    return std::array{
        F{"thickness", &Layer::thickness, "m", "of the layer at rest", 1e-5, 1},
        F{"stiffness", &Layer::stiffness, "N/m", "until it is punctured", 0, 1e7},
        F{"damping", &Layer::damping, "N s/m", "until it is punctured", 0, 1e4},
        F{"puncture", &Layer::puncture, "N", "force at which it gives way, 0: never", 0, 1e3},
        F{"cutting", &Layer::cutting, "N", "against motion through it, once it is punctured", 0,
          100},
    };
  }
};

/// Layers one behind the other. The uppermost that is whole is pressed alone, from its own surface on and however deep,
/// until it is punctured. A punctured layer resists by `cutting` alone and is whole again when the handle has left.
class Layered {
 public:
  static constexpr std::size_t kMost = 6;
  /// Speed below which `cutting` fades [m/s], so that it never chatters.
  static constexpr double kCreep = 2e-3;

  Layered() = default;
  Layered(const std::array<Layer, kMost>& layers, std::size_t count)
      : layers_(layers), count_(count) {}

  Push press(double depth, double speed) EBAC_RT {
    double friction = 0;
    double top = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const Layer& layer = layers_[i];
      if (i >= punctured_) {
        const Push own = Elastic{layer.stiffness, layer.damping}.press(std::max(0.0, depth - top),
                                                                       depth > top ? speed : 0.0);
        if (layer.puncture > 0 && own.force > layer.puncture) {
          ++punctured_;
          return press(depth, speed);
        }
        return {std::max(0.0, own.force + friction), depth > top ? own.stiffness : 0.0};
      }
      friction += layer.cutting * std::clamp(speed / kCreep, -1.0, 1.0);
      top += layer.thickness;
    }
    return {std::max(0.0, friction), 0};
  }
  double stored(double depth) const EBAC_RT {
    double top = 0;
    for (std::size_t i = 0; i < punctured_; ++i) top += layers_[i].thickness;
    if (punctured_ == count_ || depth <= top) return 0;
    return Elastic{layers_[punctured_].stiffness}.stored(depth - top);
  }
  void reset() EBAC_RT { punctured_ = 0; }

  std::size_t punctured() const EBAC_RT { return punctured_; }

 private:
  std::array<Layer, kMost> layers_{};
  std::size_t count_ = 1;
  std::size_t punctured_ = 0;
};

using Material = std::variant<Elastic, HuntCrossley, Layered>;

inline Push press(Material& material, double depth, double speed) EBAC_RT {
  return std::visit([&](auto& m) EBAC_RT { return m.press(depth, speed); }, material);
}
/// Energy that a material gives back when it is left slowly [J].
inline double stored(const Material& material, double depth) EBAC_RT {
  return std::visit([&](const auto& m) EBAC_RT { return m.stored(depth); }, material);
}
inline void reset(Material& material) EBAC_RT {
  std::visit([](auto& m) EBAC_RT { m.reset(); }, material);
}

}  // namespace ebac::world
