#pragma once

#include <cstdint>
#include <vector>

#include "ebac/faults/case.hpp"
#include "ebac/sim/sweep.hpp"

namespace ebac::faults {

/// Cases 0 to `cases` - 1 of a seed, run in `threads` threads, 0 for one per core. A case depends
/// on its number alone. After a cancellation some cases may be missing anywhere; `done` marks the
/// finished ones.
struct Campaign {
  std::vector<Result> results;
  std::vector<char> done;
};

Campaign run_campaign(std::size_t cases, std::uint64_t seed, int threads, SweepProgress& progress);

}  // namespace ebac::faults
