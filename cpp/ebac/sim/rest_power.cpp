#include "ebac/sim/rest_power.hpp"

#include <cmath>

namespace ebac {

double rest_power(const ContactRecord& record) {
  const auto rows = static_cast<double>(record.energy.size());
  if (record.energy.size() < kFewestRows) return WallContact::kNone;
  const auto tail = static_cast<std::size_t>(std::lround(kTailShare * rows));
  const auto t = record.t.last(tail);
  const auto energy = record.energy.last(tail);
  double mean_t = 0, mean_energy = 0;
  for (std::size_t i = 0; i < tail; ++i) {
    mean_t += t[i] / static_cast<double>(tail);
    mean_energy += energy[i] / static_cast<double>(tail);
  }
  double both = 0, square = 0;
  for (std::size_t i = 0; i < tail; ++i) {
    both += (t[i] - mean_t) * (energy[i] - mean_energy);
    square += (t[i] - mean_t) * (t[i] - mean_t);
  }
  return both / square;
}

}  // namespace ebac
