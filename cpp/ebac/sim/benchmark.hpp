#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "ebac/core/best_time.hpp"
#include "ebac/sim/simulate.hpp"

/// Times without Python inside: nanoseconds per step, the best of several runs, since noise only
/// adds.
namespace ebac {

/// One law on the ports it met in a run of `setup`.
template <ScalarLaw Law>
double time_law(const Setup& setup, Law law, int repeats) {
  const auto trace = simulate(setup, law);
  std::vector<Port> ports;
  ports.reserve(trace->size());
  for (std::size_t i = 0; i < trace->size(); ++i) ports.push_back(trace->sample(i).axis[0].port);
  [[maybe_unused]] volatile double sink = 0;  // so that the work is not optimised away
  return best_nanoseconds(repeats, ports.size(), [&] {
    law.reset();
    double sum = 0;
    for (const Port& port : ports) sum += law.step(port);
    sink = sum;
  });
}

/// The whole closed loop: plant, device, signal chain, environment, account, law, row.
template <ScalarLaw Law>
double time_loop(const Setup& setup, const Law& law, int repeats) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repeats; ++i) {
    auto loop = simulated_loop(setup, PerAxis<Law>(law));
    const auto trace = loop.make_trace(row_count(setup));
    best = std::min(best, best_nanoseconds(1, row_count(setup), [&] { loop.run(*trace); }));
  }
  return best;
}

}  // namespace ebac
