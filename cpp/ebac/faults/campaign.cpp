#include "ebac/faults/campaign.hpp"

namespace ebac::faults {

Campaign run_campaign(std::size_t cases, std::uint64_t seed, int threads, SweepProgress& progress) {
  Campaign campaign{.results = std::vector<Result>(cases), .done = std::vector<char>(cases, 0)};
  for_each_run(cases, threads, progress, [&](std::size_t i, ContactRecorder&) {
    campaign.results[i] = run_case(injected_fault_of(seed, i));
    campaign.done[i] = 1;
  });
  return campaign;
}

}  // namespace ebac::faults
