#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>

#include "ebac/core/realtime.hpp"

namespace ebac::sensor {

/// An IPv4 address and a port.
struct Endpoint {
  std::uint32_t address = 0;  // 127.0.0.1 is 0x7F000001
  std::uint16_t port = 0;

  bool operator==(const Endpoint&) const = default;
};

inline constexpr std::uint32_t kLoopbackAddress = 0x7F000001;

/// "192.168.1.1:49152"
inline std::string to_string(const Endpoint& at) {
  const auto byte = [&](unsigned shift) { return std::to_string(at.address >> shift & 0xFFU); };
  return byte(24) + "." + byte(16) + "." + byte(8) + "." + byte(0) + ":" + std::to_string(at.port);
}

/// The endpoint of a host by name or address. Throws std::invalid_argument where there is none; may
/// wait for a name server.
Endpoint resolve(const std::string& host, std::uint16_t port, const std::string& what = "sensor");

/// A received packet: its first bytes. A packet of the protocol is shorter than the room here, so
/// one that fills it was too long.
struct Datagram {
  static constexpr std::size_t kRoom = 128;

  std::array<std::uint8_t, kRoom> data{};
  std::size_t size = 0;
  Endpoint from{};
  std::int64_t stamp = 0;  // ns since 1970, when the kernel had it

  std::span<const std::uint8_t> bytes() const EBAC_RT { return std::span(data).first(size); }
};

/// A UDP socket that never waits, except in `wait`.
class UdpSocket {
 public:
  UdpSocket() noexcept = default;  // closed
  /// Bound to `at`; port 0 takes any free one. Throws std::system_error with the remedy.
  explicit UdpSocket(const Endpoint& at);
  ~UdpSocket() { close(); }
  UdpSocket(UdpSocket&& other) noexcept;
  UdpSocket& operator=(UdpSocket&& other) noexcept;
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  /// 0, or the error (errno).
  int send(std::span<const std::uint8_t> bytes, const Endpoint& to) EBAC_RT;
  /// Returns 0 with a packet, EAGAIN if none waits, or any other error, including one of an earlier
  /// `send` (ECONNREFUSED: no program listens there).
  int receive(Datagram& in) EBAC_RT;
  /// Waits for something to receive; false after `timeout` or a signal.
  bool wait(std::chrono::nanoseconds timeout) const noexcept;

  /// Where it is bound.
  Endpoint local() const noexcept;
  bool open() const EBAC_RT { return fd_ >= 0; }
  /// Ends the `wait` of another thread, and every later one; the socket stays open. Closing it instead would let that
  /// thread wait for whatever the system opens next under the same number.
  void end_waits() const noexcept;
  void close() noexcept;

 private:
  void forget_errors() const EBAC_RT;

  int fd_ = -1;
};

}  // namespace ebac::sensor
