#pragma once

#include <linux/can.h>

#include <string>
#include <vector>

#include "ebac/can/socketcan.hpp"

/// The steps of opening a raw CAN socket. None of them waits.
namespace ebac::can {

/// The filters as the kernel takes them: one that lets all pass where there are none.
std::vector<can_filter> to_wire(const std::vector<CanFilter>& filters);

/// A bound, non-blocking socket with its options set. Throws std::system_error.
int open_raw(const std::string& interface, const SocketCanOptions& options);

/// Binds to the interface of that name, which may be a new one: 0, or errno. Sets the filters too, as
/// the kernel drops those of an interface that goes away.
int bind_raw(int socket, const std::string& interface,
             const std::vector<can_filter>& filters) noexcept;

/// Whether the interface is there and up: 0, ENETDOWN, ENODEV.
int look_up(int socket, const std::string& interface) noexcept;

/// Forgets the error that the kernel keeps for the next call.
void forget_error(int socket) noexcept;

}  // namespace ebac::can
