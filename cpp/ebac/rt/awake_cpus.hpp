#pragma once

#include "ebac/rt/report.hpp"

namespace ebac::rt {

/// While it lives, no idle CPU of this machine sleeps: to wake one takes longer than a tick's work. Power and warmth are
/// the price. (PM QoS of the kernel: who holds /dev/cpu_dma_latency open tells the longest wake-up.)
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
  int file_ = -1;
};

}  // namespace ebac::rt
