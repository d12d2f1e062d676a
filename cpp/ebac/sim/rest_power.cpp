#include "ebac/sim/rest_power.hpp"

#include <algorithm>
#include <cmath>

namespace ebac {

namespace {

/// Whether position and force have done what they do in the tail for `kAtRest` before it.
bool at_rest(const ContactRecord& record, std::size_t tail, const WallContact& contact) {
  const double since = record.t[record.t.size() - tail] - kAtRest;
  if (!(contact.settled <= since)) return false;  // nor where it never settles
  const auto [low, high] = std::ranges::minmax(record.force.last(tail));
  const double band = std::max(kForceShare * std::abs(contact.force_rest), kForceBand);
  const auto from = std::ranges::lower_bound(record.t, since) - record.t.begin();
  return std::ranges::all_of(
      record.force.subspan(static_cast<std::size_t>(from)),
      [=](double force) { return low - band <= force && force <= high + band; });
}

}  // namespace

double rest_power(const ContactRecord& record, const WallContact& contact) {
  const auto rows = static_cast<double>(record.energy.size());
  if (record.energy.size() < kFewestRows) return WallContact::kNone;
  const auto tail = static_cast<std::size_t>(std::lround(kTailShare * rows));
  if (!at_rest(record, tail, contact)) return WallContact::kNone;
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
