#pragma once

/// Marks functions that run inside a tick: they never throw, block or allocate. With
/// EBAC_FUNCTION_EFFECTS a recent clang checks the last two as well (-Wfunction-effects).
#ifdef EBAC_FUNCTION_EFFECTS
#define EBAC_RT noexcept [[clang::nonblocking]]
#else
#define EBAC_RT noexcept
#endif

/// Whether a sanitizer watches: g++ says so by a macro, clang when asked.
#if defined(__SANITIZE_ADDRESS__)
#define EBAC_ADDRESS_SANITIZER
#elif defined(__SANITIZE_THREAD__)
#define EBAC_THREAD_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define EBAC_ADDRESS_SANITIZER
#elif __has_feature(thread_sanitizer)
#define EBAC_THREAD_SANITIZER
#endif
#endif

/// Inlines every call of the function: no calls within a simulated tick. Only in optimised code:
/// with a sanitizer it would compile for minutes.
#if defined(__OPTIMIZE__) && !defined(EBAC_ADDRESS_SANITIZER) && !defined(EBAC_THREAD_SANITIZER)
#define EBAC_ONE_FUNCTION [[gnu::flatten]]
#else
#define EBAC_ONE_FUNCTION
#endif

namespace ebac {

/// Capacity of every fixed array. The number of axes in use is a run-time count.
inline constexpr int kMaxAxes = 3;

}  // namespace ebac
