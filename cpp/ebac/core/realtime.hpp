#pragma once

/// Marks what runs inside a tick: never throws, never blocks, never allocates. With EBAC_FUNCTION_EFFECTS a
/// recent clang checks the last two as well (-Wfunction-effects).
#ifdef EBAC_FUNCTION_EFFECTS
#define EBAC_RT noexcept [[clang::nonblocking]]
#else
#define EBAC_RT noexcept
#endif

/// What it calls becomes part of the function: no calls within a simulated tick. Only in optimised code:
/// a sanitizer would make minutes of compiling of it.
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define EBAC_ONE_FUNCTION [[gnu::flatten]]
#else
#define EBAC_ONE_FUNCTION
#endif

namespace ebac {

/// Capacity of every fixed array. The number of axes in use is a run-time count.
inline constexpr int kMaxAxes = 3;

}  // namespace ebac
