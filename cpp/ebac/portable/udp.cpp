#include "ebac/sensor/udp.hpp"

#include <cerrno>
#include <utility>

#include "ebac/portable/needs_linux.hpp"

namespace ebac::sensor {

Endpoint resolve(const std::string& host, std::uint16_t, const std::string& what) {
  need_linux(what + " at " + host);
}

UdpSocket::UdpSocket(const Endpoint& at) { need_linux("a force sensor at " + to_string(at)); }
UdpSocket::UdpSocket(UdpSocket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
UdpSocket& UdpSocket::operator=(UdpSocket&& other) noexcept {
  fd_ = std::exchange(other.fd_, -1);
  return *this;
}
int UdpSocket::send(std::span<const std::uint8_t>, const Endpoint&) EBAC_RT { return EBADF; }
int UdpSocket::receive(Datagram&) EBAC_RT { return EBADF; }
bool UdpSocket::wait(std::chrono::nanoseconds) const noexcept { return false; }
void UdpSocket::end_waits() const noexcept {}
Endpoint UdpSocket::local() const noexcept { return {}; }
void UdpSocket::close() noexcept { fd_ = -1; }
void UdpSocket::forget_errors() const EBAC_RT {}

}  // namespace ebac::sensor
