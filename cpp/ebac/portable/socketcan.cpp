#include "ebac/can/socketcan.hpp"

#include "ebac/portable/needs_linux.hpp"

namespace ebac::can {

struct SocketCan::Socket {};

SocketCan::SocketCan() noexcept = default;
SocketCan::SocketCan(const std::string& interface, const SocketCanOptions&) {
  need_linux("SocketCAN interface " + interface);
}
SocketCan::~SocketCan() = default;
SocketCan::SocketCan(SocketCan&&) noexcept = default;
SocketCan& SocketCan::operator=(SocketCan&&) noexcept = default;

bool SocketCan::send(const Frame&) noexcept { return false; }
bool SocketCan::receive(Frame&) noexcept { return false; }
bool SocketCan::receive(Frame&, std::chrono::nanoseconds) noexcept { return false; }
BusState SocketCan::state() const noexcept { return BusState::kClosed; }
BusCounts SocketCan::counts() const noexcept { return {}; }
void SocketCan::close() noexcept {}

}  // namespace ebac::can
