#pragma once

#include "ebac/rt/report.hpp"

namespace ebac::rt {

/// Keeps idle CPUs of this machine from sleeping for as long as it lives: waking one takes longer
/// than the work of a tick. The cost is power and heat. (PM QoS of the kernel: the open file
/// /dev/cpu_dma_latency holds the longest allowed wake-up latency.)
class AwakeCpus {
 public:
  static constexpr const char* kFile = "/dev/cpu_dma_latency";

  /// Another `file` is for tests.
  explicit AwakeCpus(const char* file = kFile) noexcept : name_(file) {}
  ~AwakeCpus();
  AwakeCpus(const AwakeCpus&) = delete;
  AwakeCpus& operator=(const AwakeCpus&) = delete;
  AwakeCpus(AwakeCpus&&) = delete;
  AwakeCpus& operator=(AwakeCpus&&) = delete;

  /// Asked again, it lets go of what it had and asks anew.
  Grant ask();

 private:
  void let_go() noexcept;

  [[maybe_unused]] const char* name_;
  [[maybe_unused]] int file_ = -1;  // nothing where the system has no such file
};

}  // namespace ebac::rt
