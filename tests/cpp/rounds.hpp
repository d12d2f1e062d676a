#pragma once

#include "ebac/core/realtime.hpp"

namespace ebac {

/// How often a test repeats what chance decides: `all`, or the first quarter of them where a sanitizer watches, under
/// which each takes several times as long. Chance has a fixed seed: a run finds what the run before found.
constexpr int rounds(int all) {
#if defined(EBAC_ADDRESS_SANITIZER) || defined(EBAC_THREAD_SANITIZER)
  return all / 4;
#else
  return all;
#endif
}

}  // namespace ebac
