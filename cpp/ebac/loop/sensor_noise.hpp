#pragma once

#include <algorithm>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// How noisy a force sensor is, from the size of the second difference of its readings.
class SensorNoise {
 public:
  /// `declared` [N], standard deviation.
  explicit SensorNoise(double declared) EBAC_RT : declared_(declared),
                                                  bends_(kHigh* declared),
                                                  deviation_(declared) {}

  void set_tick(double dt) EBAC_RT {
    roughening_ = dt / (kRough + dt);
    averaging_ = dt / (kBends + dt);
  }

  /// Takes the size of a second difference [N]. None at all is no measure of noise: a sensor that repeats its last
  /// reading is not quiet.
  void hear(double bend) EBAC_RT {
    rough_ += ((bend > kLoud * declared_ ? 1.0 : 0.0) - rough_) * roughening_;
    if (bend != 0) bends_ += (std::min(bend, kHigh * declared_) - bends_) * averaging_;
    deviation_ = std::min(kOfBends * bends_, declared_);
  }

  /// Nothing is known of a force that is old.
  void doubt() EBAC_RT { rough_ = 1; }

  /// Whether a force is more than noise.
  bool exceeded_by(double size) const EBAC_RT { return size > kHigh * declared_; }

  /// Standard deviation [N], at most as declared.
  double deviation() const EBAC_RT { return deviation_; }

  /// Share of the last 0.1 s in which the force bent more than its declared noise does; 1 in doubt.
  double rough() const EBAC_RT { return rough_; }

 private:
  static constexpr double kLoud = 10;    // standard deviations in a second difference, 4 of its own
  static constexpr double kRough = 0.1;  // s, memory of such differences
  static constexpr double kHigh = 4;     // standard deviations: a larger difference counts as this
  static constexpr double kBends = 0.2;  // s, over which their sizes are averaged
  static constexpr double kOfBends = 0.56;  // noise of that mean; 0.51 for one that is normal

  double declared_;                        // N
  double rough_ = 0;                       // share of ticks
  double bends_;                           // N, mean size of second differences
  double deviation_;                       // N
  double roughening_ = 0, averaging_ = 0;  // share taken per tick
};

}  // namespace ebac
