#pragma once

#include <memory>

#include "ebac/control/any_law.hpp"
#include "ebac/loop/trace.hpp"
#include "ebac/model/device.hpp"
#include "ebac/model/environment.hpp"
#include "ebac/sim/replay_device.hpp"

namespace ebac::python {

/// A law driven by a recorded log. Throws std::invalid_argument where the log has another number of
/// axes than the device.
std::shared_ptr<Trace> replay_on(const std::shared_ptr<ReplayLog>& log, const AnyLaw& law,
                                 const DeviceModel& device, const Environment& environment);

}  // namespace ebac::python
