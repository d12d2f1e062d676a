#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "ebac/core/realtime.hpp"
#include "ebac/core/timing.hpp"

namespace ebac {

/// Commands given but not yet acting: the last `delay` of them, oldest first.
class CommandsInFlight {
 public:
  explicit CommandsInFlight(int delay) EBAC_RT : size_(delay) {}

  int size() const EBAC_RT { return size_; }
  double operator[](int j) const EBAC_RT { return force_[static_cast<std::size_t>(j)]; }

  void push(double force) EBAC_RT {
    if (size_ == 0) return;
    for (int j = 1; j < size_; ++j) {
      force_[static_cast<std::size_t>(j - 1)] = force_[static_cast<std::size_t>(j)];
    }
    force_[static_cast<std::size_t>(size_ - 1)] = force;
  }

  /// Size of the largest among them and one more.
  double largest_with(double force) const EBAC_RT {
    double most = std::abs(force);
    for (int j = 0; j < size_; ++j) most = std::max(most, std::abs((*this)[j]));
    return most;
  }

  double sum_of_squares() const EBAC_RT {
    double sum = 0;
    for (int j = 0; j < size_; ++j) sum += (*this)[j] * (*this)[j];
    return sum;
  }

 private:
  int size_;
  std::array<double, kMaxDelay + 1> force_{};  // one more for what belongs to the command that acts
};

}  // namespace ebac
