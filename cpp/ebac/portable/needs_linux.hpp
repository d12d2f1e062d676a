#pragma once

#include <string>
#include <system_error>

/// What a build without Linux's interfaces (EBAC_PORTABLE) gives for them: the same functions, which refuse.
namespace ebac {

/// Throws std::system_error: `what` needs Linux.
[[noreturn]] inline void need_linux(const std::string& what) {
  throw std::system_error(
      std::make_error_code(std::errc::function_not_supported),
      what + " needs Linux; this build of ebac simulates, identifies and plots only");
}

}  // namespace ebac
