#pragma once

#include <cmath>
#include <memory>

#include "ebac/control/per_axis.hpp"
#include "ebac/loop/loop.hpp"
#include "ebac/loop/virtual_clock.hpp"
#include "ebac/sim/simulated_device.hpp"

namespace ebac {

/// The loop of a simulated run.
template <AxesController Law>
Loop<SimulatedDevice, VirtualClock, Law> simulated_loop(const Setup& setup, Law law) {
  const SignalChain chain(setup.device, setup.environment, law.timing(),
                          observing(setup.observer, law));
  return {SimulatedDevice(setup), VirtualClock(setup.timing.dt, setup.jitter, setup.seed),
          std::move(law),         chain,
          setup.device.axes(),    setup.loop};
}

/// Runs `setup` under `law` to its end and returns every row.
template <AxesController Law>
std::shared_ptr<Trace> simulate(const Setup& setup, Law law) {
  auto loop = simulated_loop(setup, std::move(law));
  auto trace = loop.make_trace(row_count(setup));
  loop.run(*trace);
  return trace;
}

template <ScalarLaw Law>
std::shared_ptr<Trace> simulate(const Setup& setup, const Law& law) {
  return simulate(setup, PerAxis<Law>(law));
}

}  // namespace ebac
