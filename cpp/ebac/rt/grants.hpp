#pragma once

#include "ebac/rt/report.hpp"

/// Real-time resources of a thread. Nothing here throws on a refusal: it is reported.
namespace ebac::rt {

/// SCHED_FIFO for the calling thread.
Grant ask_priority(int priority);
/// The calling thread on one CPU.
Grant ask_cpu(int cpu);
/// All pages of the process in memory, now and later (mlockall). Refused, too, where a finite limit
/// would let a later allocation fail.
Grant ask_memory();
/// Releases the memory lock of `ask_memory`.
void release_memory() noexcept;
/// Touches `bytes` of the stack of the calling thread.
Grant touch_stack(int bytes);

}  // namespace ebac::rt
