#include "ebac/sim/ebac_loop.hpp"

#include "ebac/sim/benchmark.hpp"

namespace ebac {

std::shared_ptr<Trace> simulate_ebac(const Setup& setup, const Ebac& law) {
  return simulate(setup, law);
}

double time_ebac_loop(const Setup& setup, const Ebac& law, int repeats) {
  return time_loop(setup, law, repeats);
}

}  // namespace ebac
