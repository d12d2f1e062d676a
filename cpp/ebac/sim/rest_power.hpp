#pragma once

#include "ebac/sim/contact.hpp"

namespace ebac {

inline constexpr double kAtRest = 20;  // s, before the tail: shorter, and settling is in the slope

/// Mean rate of the port energy over the last 30 % of a run, dW/dt at rest [W], by least squares;
/// negative where the port gives out energy as long as it is held. NaN without energies, and unless
/// the run is at rest from 20 s before its tail on: the position stays within 0.125 mm of its rest,
/// and the force, which may click, within what it does in the tail, widened by the band of
/// settling. `contact` is what `measure_contact` finds in `record`.
double rest_power(const ContactRecord& record, const WallContact& contact);

}  // namespace ebac
