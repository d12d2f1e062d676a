#pragma once

/// Marks what runs inside a tick: never throws, never blocks, never allocates.
#if defined(__clang__) && defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::nonblocking)
#define EBAC_RT noexcept [[clang::nonblocking]]
#endif
#endif
#ifndef EBAC_RT
#define EBAC_RT noexcept
#endif

namespace ebac {

/// Capacity of every fixed array. The number of axes in use is a run-time count.
inline constexpr int kMaxAxes = 3;

}  // namespace ebac
