#pragma once

#include <string>
#include <vector>

namespace ebac::rt {

/// One resource that a thread requested.
struct Grant {
  std::string name;   // "priority", "memory", "stack", "cpu", "sleep"
  std::string asked;  // "SCHED_FIFO 80"
  bool granted;
  std::string why;     // why not; empty where it was granted
  std::string remedy;  // the command that would grant it; empty where it was granted
};

/// Resources that a thread requested and was granted.
struct Report {
  std::vector<Grant> grants;

  bool complete() const {
    for (const Grant& grant : grants) {
      if (!grant.granted) return false;
    }
    return true;
  }
};

}  // namespace ebac::rt
