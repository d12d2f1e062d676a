#pragma once

#include <memory>
#include <vector>

#include "ebac/control/any_law.hpp"
#include "ebac/sim/press.hpp"
#include "ebac/sim/replay_device.hpp"
#include "ebac/sim/setup.hpp"

/// Runs of a law whose type is known at run time only: the templates of simulate.hpp, replay.hpp,
/// sweep.hpp, press.hpp and benchmark.hpp, compiled once for all laws.
namespace ebac {

std::shared_ptr<Trace> simulate_any(const Setup& setup, const AnyLaw& law);

std::shared_ptr<Trace> replay_any(std::shared_ptr<const ReplayLog> log, const AnyLaw& law,
                                  const DeviceModel& device, const Environment& environment);

std::vector<Outcome> sweep_any(const std::vector<const Setup*>& setups,
                               const std::vector<const AnyLaw*>& laws, int threads,
                               const RunLimits& limits, SweepProgress& progress);

std::vector<Press> press_any(const std::vector<const Setup*>& setups,
                             const std::vector<const AnyLaw*>& laws,
                             const std::vector<double>& goals, int threads, const RunLimits& limits,
                             SweepProgress& progress);

double time_law_any(const Setup& setup, const AnyLaw& law, int repeats);
double time_loop_any(const Setup& setup, const AnyLaw& law, int repeats);

}  // namespace ebac
