#pragma once

namespace ebac::rt {

/// Number of this process.
int own_process() noexcept;

/// Whether a process of that number is at work: one that has ended is not, even where nobody has asked for its end yet.
bool process_lives(int process) noexcept;

}  // namespace ebac::rt
