#pragma once

#include <algorithm>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// A reading of the encoder or the force sensor, and how old it was when it was read [s].
struct Aged {
  double value = 0;
  double age = 0;
};

/// The last two records of the force sensor and their mean age. Without an age, readings pass as
/// they are.
class ForceHistory {
 public:
  /// What the sensor showed one mean age ago [N]. Ages above `limit` do not count.
  double at_mean_age(const Aged& read, double dt, double limit) EBAC_RT {
    if (!started_) {
      if (read.age == 0) return read.value;
      newest_ = older_ = read;
      mean_age_ = std::min(read.age, limit);
      return started_ = true, read.value;
    }
    newest_.age += dt;
    older_.age += dt;
    if (newest_.age - read.age > kSame * dt) {
      older_ = newest_;
      newest_ = read;
    }
    if (newest_.age <= limit) mean_age_ += (newest_.age - mean_age_) * dt / (kMemory + dt);
    const double between = older_.age - newest_.age;
    if (!(between > 0)) return newest_.value;
    const double back = std::clamp((mean_age_ - newest_.age) / between, -1.0, 1.0);
    return newest_.value + back * (older_.value - newest_.value);
  }
  bool started() const EBAC_RT { return started_; }
  double mean_age() const EBAC_RT { return mean_age_; }  // s

 private:
  static constexpr double kMemory = 0.2;  // s, of the mean
  static constexpr double kSame = 0.01;   // ticks: records as close as this are one
  bool started_ = false;
  Aged newest_, older_;
  double mean_age_ = 0;
};

}  // namespace ebac
