#include <cstdio>
#include <ebac/sim/simulate.hpp>

#include "damped.hpp"

/// The virtual wall of the paper under a law of your own, without Python.
int main() {
  const ebac::Setup setup;
  const Damped law(Damped::Params::design(setup.device.facts(), setup.timing), setup.timing);
  const auto trace = ebac::simulate(setup, law);

  const ebac::Sample last = trace->sample(trace->size() - 1);
  std::printf("%s: %zu ticks, rests at %.3f mm under %.2f N\n", Damped::kName.data(), trace->size(),
              1e3 * last.axis[0].port.x, last.axis[0].port.f_applied);
  return last.fault == ebac::Fault::kNone ? 0 : 1;
}
