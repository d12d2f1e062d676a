#pragma once

#include <memory>
#include <optional>

#include "ebac/control/any_law.hpp"
#include "ebac/loop/trace.hpp"
#include "ebac/sim/setup.hpp"
#include "ebac/simulated_drives/timed_bus.hpp"

namespace ebac::python {

/// A run with the plant at hand, or behind a CAN bus with simulated drives, which may take time.
std::shared_ptr<Trace> simulate_either(const Setup& setup, const AnyLaw& law, bool through_can,
                                       const std::optional<can::TimedBus>& bus);

}  // namespace ebac::python
