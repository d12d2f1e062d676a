#pragma once

#include <algorithm>
#include <chrono>
#include <concepts>
#include <cstdint>
#include <utility>
#include <vector>

#include "ebac/can/bus.hpp"
#include "ebac/rt/once_thread.hpp"

namespace ebac::can {

/// A node of a bus: receives frames and queues answers. A drive, or a joystick of drives.
template <class N>
concept Node = requires(N node, const Frame& in, Frame& out) {
  { node.receive(in) } noexcept;
  { node.take(out) } noexcept -> std::same_as<bool>;
};

/// A bus on whose end a thread can also wait.
template <class B>
concept WaitingBus =
    Bus<B> && requires(B bus, const B& view, Frame& in, std::chrono::nanoseconds t) {
      { bus.receive(in, t) } noexcept -> std::same_as<bool>;
      { view.counts() } noexcept -> std::same_as<BusCounts>;
      { bus.close() } noexcept;
    };

/// A node with timers.
template <class N>
concept TimedNode = Node<N> && requires(N node, double seconds) {
  { node.elapse(seconds) } noexcept;
};

/// Runs nodes on a bus in real time, in a thread of their own: a frame is answered when it arrives,
/// and the timers of the nodes run with the clock. If the bus stamps frames with the time of day, a
/// frame that waited for the thread counts from its arrival: a late thread makes answers late, but
/// triggers no watchdog.
template <WaitingBus B, TimedNode N>
class NodeServer {
 public:
  NodeServer(B bus, N node) : bus_(std::move(bus)), node_(std::move(node)) {}
  NodeServer(const NodeServer&) = delete;
  NodeServer& operator=(const NodeServer&) = delete;
  NodeServer(NodeServer&&) = delete;
  NodeServer& operator=(NodeServer&&) = delete;
  ~NodeServer() { stop(); }

  /// Starts the thread, once: throws std::logic_error the second time or after a stop, and what rt::Thread throws.
  void start(rt::Mode mode = rt::Mode::kOff, const rt::Options& options = {}) {
    thread_.start("these nodes have been on their bus already: make new ones", mode, options,
                  [this] { work(); });
  }
  /// Takes them off the bus, within a few ms; nothing the second time. From any thread, and from several, also while
  /// another starts them.
  void stop() noexcept {
    thread_.stop([this] { bus_.close(); });
  }

  /// Resources its thread requested and was granted; empty before the start.
  std::vector<rt::Grant> grants() const { return thread_.grants(); }

  /// May be called by any thread, at any time.
  BusState state() const noexcept { return bus_.state(); }
  BusCounts counts() const noexcept { return bus_.counts(); }

  /// To be used only while the thread does not run.
  const N& node() const noexcept { return node_; }

 private:
  using Steady = std::chrono::steady_clock;

  /// Longest wait for a frame: how late a timer of the nodes is at most.
  static constexpr std::chrono::nanoseconds kTimer = std::chrono::milliseconds{1};

  void work() noexcept {
    last_ = Steady::now();
    answer();
    for (Frame frame; !thread_.over(); answer()) {
      const bool came = bus_.receive(frame, kTimer);
      pass_until(Steady::now() - (came ? age(frame) : std::chrono::nanoseconds{0}));
      if (came) node_.receive(frame);
    }
  }

  void pass_until(Steady::time_point now) noexcept {
    if (now <= last_) return;
    node_.elapse(std::chrono::duration<double>(now - last_).count());
    last_ = now;
  }

  void answer() noexcept {
    Frame out;
    while (node_.take(out)) static_cast<void>(bus_.send(out));
  }

  /// Time since the frame arrived; 0 if it carries no stamp.
  static std::chrono::nanoseconds age(const Frame& frame) noexcept {
    if (frame.stamp == 0) return std::chrono::nanoseconds{0};
    const std::chrono::nanoseconds now = std::chrono::system_clock::now().time_since_epoch();
    return std::max(now - std::chrono::nanoseconds{frame.stamp}, std::chrono::nanoseconds{0});
  }

  B bus_;
  N node_;
  Steady::time_point last_;  // until then time has passed for the nodes
  rt::OnceThread thread_;    // last: it is joined before the others go
};

}  // namespace ebac::can
