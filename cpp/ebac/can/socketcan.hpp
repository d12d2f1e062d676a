#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ebac/can/bus.hpp"

namespace ebac::can {

/// Passes frames whose identifier equals `id` wherever `mask` is 1, with this identifier length.
struct CanFilter {
  std::uint32_t id = 0;
  std::uint32_t mask = kStandardIds;
  bool extended = false;
};

/// How an end of a SocketCAN interface is opened.
struct SocketCanOptions {
  std::vector<CanFilter> filters{};  // any one of them lets a frame through; none: all pass
  bool own = false;                  // also receives its own frames
  bool errors = false;               // passes on error frames of the controller
};

/// One end of a CAN interface of the Linux kernel: raw, classical frames, stamped by the kernel.
/// The controller's error frames become the state. An interface that goes down, or away with its
/// plug, is `kDown` until it is there again under its name; then the same object goes on. One
/// thread may send while another receives.
class SocketCan {
 public:
  SocketCan() noexcept;  // an end of nothing: closed
  /// Throws std::system_error, with the remedy, when the kernel has no CAN support or the interface
  /// is missing, down, or no CAN interface.
  explicit SocketCan(const std::string& interface, const SocketCanOptions& options = {});
  ~SocketCan();
  SocketCan(SocketCan&&) noexcept;
  SocketCan& operator=(SocketCan&&) noexcept;
  SocketCan(const SocketCan&) = delete;
  SocketCan& operator=(const SocketCan&) = delete;

  bool send(const Frame& out) noexcept;
  bool receive(Frame& in) noexcept;
  /// Waits for a frame, for the tick of no loop: false after `timeout`, a signal, or `close`.
  bool receive(Frame& in, std::chrono::nanoseconds timeout) noexcept;

  /// As far as known from the last `send` or `receive`.
  BusState state() const noexcept;
  BusCounts counts() const noexcept;
  /// Stops sending and receiving. A thread waiting in `receive` returns within 0.1 s.
  void close() noexcept;

 private:
  struct Socket;
  std::unique_ptr<Socket> socket_;
};

static_assert(Bus<SocketCan>);

}  // namespace ebac::can
