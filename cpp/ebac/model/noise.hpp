#pragma once

#include <cmath>
#include <cstdint>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Random numbers that are the same bits on every machine: splitmix64 (Steele, Lea, Flood 2014),
/// and the polar method for the normal distribution. The standard library's distributions differ
/// between vendors.
class Noise {
 public:
  explicit Noise(std::uint64_t seed, std::uint64_t stream = 0) EBAC_RT
      : state_(seed + 0x632BE59BD9B4E019ULL * (stream + 1)) {}

  std::uint64_t bits() EBAC_RT {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }

  /// Uniform in [-1, 1).
  double symmetric() EBAC_RT { return static_cast<double>(bits() >> 11) * 0x1p-52 - 1.0; }

  /// Standard normal.
  double normal() EBAC_RT {
    for (;;) {
      const double a = symmetric();
      const double b = symmetric();
      const double s = a * a + b * b;
      if (s > 0 && s < 1) return a * std::sqrt(-2 * std::log(s) / s);
    }
  }

 private:
  std::uint64_t state_;
};

}  // namespace ebac
