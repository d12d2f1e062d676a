#pragma once

#include <chrono>
#include <cstddef>
#include <memory>

#include "ebac/can/bus.hpp"

namespace ebac::can {

class LoopbackBus;

/// How one end of a loopback bus is opened.
struct LoopbackOptions {
  static constexpr std::size_t kMostFrames = std::size_t{1} << 20;

  std::size_t frames = 1024;  // that wait to be received, 1 to kMostFrames; what exceeds it is lost
  bool own = false;           // receives what it sent itself, too
};

/// A CAN bus inside one process. Every end receives every frame of the others, all in one order.
/// A cheap reference: copies are the same bus, which lives as long as one of them or of its ends.
class LoopbackHub {
 public:
  enum class Stamps : bool { kNone, kWallClock };  // kWallClock: ns since 1970

  explicit LoopbackHub(Stamps stamps = Stamps::kNone);

  /// Throws std::invalid_argument when the options are out of range.
  LoopbackBus open(LoopbackOptions options = {});

  /// How many ends are open.
  std::size_t ends() const;

 private:
  friend class LoopbackBus;
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

/// One end of it. No call allocates, locks or throws, and any thread may make any of them at any
/// time. A frame sent is put into one small queue for all; whoever finds nobody delivering delivers
/// until it is empty, so a sender held up by the system holds up no other sender. Closes itself.
class LoopbackBus {
 public:
  LoopbackBus() = default;  // an end of nothing: closed
  ~LoopbackBus();
  LoopbackBus(LoopbackBus&&) noexcept = default;
  LoopbackBus& operator=(LoopbackBus&& other) noexcept;
  LoopbackBus(const LoopbackBus&) = delete;
  LoopbackBus& operator=(const LoopbackBus&) = delete;

  /// True also where nobody listens, or somebody's queue is full: as on the wire, that is not the
  /// sender's business.
  bool send(const Frame& out) noexcept;
  bool receive(Frame& in) noexcept;
  /// Waits for a frame, for the tick of no loop: false after `timeout`, a signal, or `close`.
  bool receive(Frame& in, std::chrono::nanoseconds timeout) noexcept;

  BusState state() const noexcept;
  BusCounts counts() const noexcept;
  /// Leaves the bus; who waits in `receive` returns.
  void close() noexcept;

 private:
  friend class LoopbackHub;
  struct End;
  std::shared_ptr<LoopbackHub::Shared> hub_;
  std::shared_ptr<End> end_;
};

static_assert(Bus<LoopbackBus>);

}  // namespace ebac::can
