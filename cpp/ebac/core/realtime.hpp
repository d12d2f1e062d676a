#pragma once

/// Marks functions that run inside a tick: they never throw, block or allocate. With
/// EBAC_FUNCTION_EFFECTS a recent clang checks the last two as well (-Wfunction-effects).
#ifdef EBAC_FUNCTION_EFFECTS
#define EBAC_RT noexcept [[clang::nonblocking]]
#else
#define EBAC_RT noexcept
#endif

/// Inlines every call of the function: no calls within a simulated tick. Only in optimised code:
/// with a sanitizer it would compile for minutes.
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define EBAC_ONE_FUNCTION [[gnu::flatten]]
#else
#define EBAC_ONE_FUNCTION
#endif

namespace ebac {

/// Capacity of every fixed array. The number of axes in use is a run-time count.
inline constexpr int kMaxAxes = 3;

}  // namespace ebac
