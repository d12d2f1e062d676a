#pragma once

#include "ebac/sim/contact.hpp"

namespace ebac {

/// Mean rate of the port energy over the last 30 % of a run, dW/dt at rest [W], by least squares;
/// negative where the port gives out energy as long as it is held. NaN without energies.
double rest_power(const ContactRecord& record);

}  // namespace ebac
