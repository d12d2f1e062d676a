#include "ebac/sensor/udp.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace ebac::sensor {

namespace {

sockaddr_in to_wire(const Endpoint& at) noexcept {
  sockaddr_in wire{};
  wire.sin_family = AF_INET;
  wire.sin_port = htons(at.port);
  wire.sin_addr.s_addr = htonl(at.address);
  return wire;
}

Endpoint from_wire(const sockaddr_in& wire) noexcept {
  return {.address = ntohl(wire.sin_addr.s_addr), .port = ntohs(wire.sin_port)};
}

std::string remedy(int error) {
  switch (error) {
    case EADDRINUSE:
      return "the port is taken; end the other program, or give another port (0 takes any)";
    case EADDRNOTAVAIL:
      return "this machine has no such address; `ip address` lists those it has";
    case EACCES:
      return "not allowed; give a port above 1023";
    default:
      return "cannot be opened";
  }
}

bool set(int fd, int level, int option) noexcept {
  const int on = 1;
  return ::setsockopt(fd, level, option, &on, sizeof(on)) == 0;
}

/// Arrival time of the packet at the kernel; 0 if unknown.
std::int64_t stamp_of(msghdr& message) noexcept {
  for (cmsghdr* part = CMSG_FIRSTHDR(&message); part; part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SO_TIMESTAMPNS) continue;
    timespec at{};
    std::memcpy(&at, CMSG_DATA(part), sizeof(at));
    return std::int64_t{at.tv_sec} * 1'000'000'000 + at.tv_nsec;
  }
  return 0;
}

}  // namespace

Endpoint resolve(const std::string& host, std::uint16_t port, const std::string& what) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(host.c_str(), nullptr, &hints, &found);
  if (error != 0 || found == nullptr) {
    throw std::invalid_argument(
        what + " at '" + host + "': no such host (" + ::gai_strerror(error) +
        "); give its IPv4 address, as 192.168.1.1, or a name that resolves");
  }
  sockaddr_in wire{};
  std::memcpy(&wire, found->ai_addr, sizeof(wire));
  ::freeaddrinfo(found);
  Endpoint at = from_wire(wire);
  at.port = port;
  return at;
}

UdpSocket::UdpSocket(const Endpoint& at)
    : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  const sockaddr_in wire = to_wire(at);
  const auto* any = reinterpret_cast<const sockaddr*>(&wire);
  // IP_RECVERR reports errors of sent packets: without a connection, nothing else does.
  if (fd_ < 0 || !set(fd_, SOL_SOCKET, SO_TIMESTAMPNS) || !set(fd_, IPPROTO_IP, IP_RECVERR) ||
      ::bind(fd_, any, sizeof(wire)) != 0) {
    const int error = errno;
    close();
    throw std::system_error(error, std::generic_category(),
                            "UDP at " + to_string(at) + ": " + remedy(error));
  }
}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

UdpSocket& UdpSocket::operator=(UdpSocket&& other) noexcept {
  if (this != &other) {
    close();
    fd_ = std::exchange(other.fd_, -1);
  }
  return *this;
}

void UdpSocket::close() noexcept {
  if (fd_ >= 0) ::close(std::exchange(fd_, -1));
}

int UdpSocket::send(std::span<const std::uint8_t> bytes, const Endpoint& to) EBAC_RT {
  const sockaddr_in wire = to_wire(to);
  const auto* any = reinterpret_cast<const sockaddr*>(&wire);
  int error = 0;
  // Twice: the first failure may belong to an earlier packet.
  for (int i = 0; i < 2; ++i) {
    const ssize_t sent =
        ::sendto(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL, any, sizeof(wire));
    if (sent >= 0) return 0;
    error = errno;
    forget_errors();
  }
  return error;
}

int UdpSocket::receive(Datagram& in) EBAC_RT {
  sockaddr_in from{};
  iovec into{.iov_base = in.data.data(), .iov_len = in.data.size()};
  alignas(cmsghdr) std::array<char, 128> extra{};
  msghdr message{};
  message.msg_name = &from;
  message.msg_namelen = sizeof(from);
  message.msg_iov = &into;
  message.msg_iovlen = 1;
  message.msg_control = extra.data();
  message.msg_controllen = extra.size();
  const ssize_t bytes = ::recvmsg(fd_, &message, MSG_DONTWAIT);
  if (bytes < 0) {
    const int error = errno == EWOULDBLOCK ? EAGAIN : errno;
    if (error != EAGAIN) forget_errors();
    return error;
  }
  in.size = static_cast<std::size_t>(bytes);
  in.from = from_wire(from);
  in.stamp = stamp_of(message);
  return 0;
}

/// Empties the error queue, which would fill up unread; the error itself has been reported.
void UdpSocket::forget_errors() const EBAC_RT {
  constexpr int kMost = 16;
  std::array<char, 64> data{};
  for (int i = 0; i < kMost; ++i) {
    if (::recv(fd_, data.data(), data.size(), MSG_ERRQUEUE | MSG_DONTWAIT) < 0) return;
  }
}

bool UdpSocket::wait(std::chrono::nanoseconds timeout) const noexcept {
  const auto ns = std::max<std::int64_t>(timeout.count(), 0);
  const timespec most{.tv_sec = ns / 1'000'000'000, .tv_nsec = ns % 1'000'000'000};
  pollfd one{.fd = fd_, .events = POLLIN, .revents = 0};
  return ::ppoll(&one, 1, &most, nullptr) > 0;
}

void UdpSocket::end_waits() const noexcept {
  ::shutdown(fd_, SHUT_RD);  // says ENOTCONN, and wakes all the same
}

Endpoint UdpSocket::local() const noexcept {
  sockaddr_in wire{};
  socklen_t size = sizeof(wire);
  if (::getsockname(fd_, reinterpret_cast<sockaddr*>(&wire), &size) != 0) return {};
  return from_wire(wire);
}

}  // namespace ebac::sensor
