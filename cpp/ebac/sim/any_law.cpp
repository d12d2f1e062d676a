#include "ebac/sim/any_law.hpp"

#include <utility>

#include "ebac/control/law_type.hpp"
#include "ebac/sim/benchmark.hpp"
#include "ebac/sim/ebac_loop.hpp"
#include "ebac/sim/replay.hpp"
#include "ebac/sim/simulate.hpp"

namespace ebac {

std::shared_ptr<Trace> simulate_any(const Setup& setup, const AnyLaw& law) {
  if (const auto* ebac = law_cast<Ebac>(law)) return simulate_ebac(setup, *ebac);
  return simulate(setup, law);
}

std::shared_ptr<Trace> replay_any(std::shared_ptr<const ReplayLog> log, const AnyLaw& law,
                                  const DeviceModel& device, const Environment& environment) {
  return replay(std::move(log), PerAxis<AnyLaw>(law), device, environment);
}

std::vector<Outcome> sweep_any(const std::vector<const Setup*>& setups,
                               const std::vector<const AnyLaw*>& laws, int threads,
                               const RunLimits& limits, SweepProgress& progress) {
  return sweep(setups, laws, threads, limits, progress);
}

std::vector<Press> press_any(const std::vector<const Setup*>& setups,
                             const std::vector<const AnyLaw*>& laws,
                             const std::vector<double>& goals, int threads, const RunLimits& limits,
                             SweepProgress& progress) {
  return press(setups, laws, goals, threads, limits, progress);
}

double time_law_any(const Setup& setup, const AnyLaw& law, int repeats) {
  return time_law(setup, law, repeats);
}

double time_loop_any(const Setup& setup, const AnyLaw& law, int repeats) {
  if (const auto* ebac = law_cast<Ebac>(law)) return time_ebac_loop(setup, *ebac, repeats);
  return time_loop(setup, law, repeats);
}

}  // namespace ebac
