#pragma once

#include "ebac/rt/report.hpp"

namespace ebac::rt {

/// Keeps idle CPUs of this machine from sleeping for as long as it lives: waking one takes longer
/// than the work of a tick. The cost is power and heat. (PM QoS of the kernel: the open file
/// /dev/cpu_dma_latency holds the longest allowed wake-up latency.)
class AwakeCpus {
 public:
  AwakeCpus() = default;
  ~AwakeCpus();
  AwakeCpus(const AwakeCpus&) = delete;
  AwakeCpus& operator=(const AwakeCpus&) = delete;
  AwakeCpus(AwakeCpus&&) = delete;
  AwakeCpus& operator=(AwakeCpus&&) = delete;

  /// Once in a life.
  Grant ask();

 private:
  [[maybe_unused]] int file_ = -1;  // nothing where the system has no such file
};

}  // namespace ebac::rt
