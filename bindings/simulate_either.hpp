#pragma once

#include <memory>
#include <utility>

#include "ebac/can/through_can.hpp"
#include "ebac/sim/simulate.hpp"

namespace ebac::python {

/// A run with the plant at hand, or behind a CAN bus with simulated drives.
template <AxesController Law>
std::shared_ptr<Trace> simulate_either(const Setup& setup, Law law, bool through_can) {
  if (!through_can) return simulate(setup, std::move(law));
  return can::simulate_through_can<SimulatedDevice>(setup, std::move(law), row_count(setup));
}

}  // namespace ebac::python
