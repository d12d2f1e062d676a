#pragma once

#include "ebac/faults/watching.hpp"
#include "ebac/model/limits.hpp"
#include "ebac/sim/setup.hpp"
#include "ebac/simulated_drives/wiring.hpp"

namespace ebac::faults {

/// Everything of a case but the fault: device, hand, world, limits, plan, and how it is wired and watched.
struct CaseSetup {
  Setup setup{};
  DeviceModel known{};  // to the loop
  Limits limits{};
  RunPlan plan{};
  can::Wiring wiring{};
  Watching watching{};
};

CaseSetup case_setup_of(const InjectedFault& injected);

}  // namespace ebac::faults
