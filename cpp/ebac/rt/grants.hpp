#pragma once

#include "ebac/rt/options.hpp"
#include "ebac/rt/report.hpp"

/// What a thread asks of the system for itself. Nothing here throws on a refusal: it is reported.
namespace ebac::rt {

/// SCHED_FIFO for the calling thread.
Grant ask_priority(int priority);
/// The calling thread on one CPU.
Grant ask_cpu(int cpu);
/// All pages of the process in memory, now and later (mlockall). Refused, too, where a finite limit
/// would let a later allocation fail.
Grant ask_memory();
/// Ends what `ask_memory` got.
void release_memory() noexcept;
/// Touches `bytes` of the stack of the calling thread.
Grant touch_stack(int bytes);

/// What `options` name for the calling thread. Memory is the process's and sleep the machine's: those
/// are asked for apart.
Report ask(const Options& options);

}  // namespace ebac::rt
