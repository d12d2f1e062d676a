#pragma once

#include <memory>

#include "ebac/control/any_law.hpp"
#include "ebac/loop/trace.hpp"
#include "ebac/sim/setup.hpp"

namespace ebac::python {

/// A run with the plant at hand, or behind a CAN bus with simulated drives.
std::shared_ptr<Trace> simulate_either(const Setup& setup, const AnyLaw& law, bool through_can);

}  // namespace ebac::python
