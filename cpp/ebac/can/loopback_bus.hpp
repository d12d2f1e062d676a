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

  std::size_t frames = 1024;  // receive queue, 1 to kMostFrames; frames beyond it are lost
  bool own = false;           // also receives its own frames
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

/// One end of a loopback bus. No call allocates or throws, and any thread may call any of them at
/// any time. A sent frame enters one small queue for all; a sender that finds no other thread
/// delivering delivers until the queue is empty. A sender that the system holds up makes no other
/// one wait; only the frames behind its own do. Closes itself.
class LoopbackBus {
 public:
  LoopbackBus() = default;  // an end of nothing: closed
  ~LoopbackBus();
  LoopbackBus(LoopbackBus&&) noexcept = default;
  LoopbackBus& operator=(LoopbackBus&& other) noexcept;
  LoopbackBus(const LoopbackBus&) = delete;
  LoopbackBus& operator=(const LoopbackBus&) = delete;

  /// True also when no node listens or a receive queue is full: as on the wire, the sender does not
  /// learn of it.
  bool send(const Frame& out) noexcept;
  bool receive(Frame& in) noexcept;
  /// Waits for a frame, for the tick of no loop: false after `timeout`, a signal, or `close`.
  bool receive(Frame& in, std::chrono::nanoseconds timeout) noexcept;

  BusState state() const noexcept;
  BusCounts counts() const noexcept;
  /// Leaves the bus, once no thread delivers; a thread waiting in `receive` returns.
  void close() noexcept;

 private:
  friend class LoopbackHub;
  struct End;
  std::shared_ptr<LoopbackHub::Shared> hub_;
  std::shared_ptr<End> end_;
};

static_assert(Bus<LoopbackBus>);

}  // namespace ebac::can
