#pragma once

#include "ebac/loop/run_state_machine.hpp"
#include "ebac/loop/safety_limiter.hpp"

namespace ebac {

/// Options of a loop: start and end of a run, and its safety limits.
struct LoopOptions {
  RunPlan plan{};
  SafetyLimiter limiter{};
};

}  // namespace ebac
