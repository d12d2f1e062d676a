#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>

namespace ebac {

/// Nanoseconds of each of `steps` steps of `work`: the best of several runs, since noise only adds.
template <class Work>
double best_nanoseconds(int repeats, std::size_t steps, Work work) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
    best = std::min(best, taken.count() / static_cast<double>(steps));
  }
  return best;
}

}  // namespace ebac
