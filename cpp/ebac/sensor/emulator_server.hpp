#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "ebac/loop/mailbox.hpp"
#include "ebac/rt/once_thread.hpp"
#include "ebac/sensor/emulator.hpp"
#include "ebac/sensor/udp.hpp"

namespace ebac::sensor {

/// An emulated sensor on the network, in real time, in a thread of its own.
class EmulatorServer {
 public:
  using Force = std::array<double, kMaxAxes>;
  /// The force of the hand on the handle [N], requested once per sample with the time since the
  /// last one [s]; called by the thread only.
  using Source = std::function<Force(double)>;

  /// Throws std::system_error when the address cannot be had.
  EmulatorServer(const Endpoint& at, const RdtEmulator<Endpoint>& emulator, Source source);
  ~EmulatorServer() { stop(); }
  EmulatorServer(const EmulatorServer&) = delete;
  EmulatorServer& operator=(const EmulatorServer&) = delete;
  EmulatorServer(EmulatorServer&&) = delete;
  EmulatorServer& operator=(EmulatorServer&&) = delete;

  /// Once in a life: throws std::logic_error the second time or after a stop, and as rt::Thread.
  void start(rt::Mode mode = rt::Mode::kOff, const rt::Options& options = {});
  /// Silent for good, within a few ms; nothing the second time. From any thread, and from several, also
  /// while another starts it.
  void stop() noexcept;

  /// Resources its thread requested and was granted; empty before the start.
  std::vector<rt::Grant> grants() const { return thread_.grants(); }

  /// Of any thread, at any time.
  void set(const EmulatorTrouble& trouble);
  EmulatorCounts counts() const;
  Endpoint local() const noexcept { return local_; }

 private:
  using Steady = std::chrono::steady_clock;

  void work() noexcept;
  void hear() noexcept;
  void sample(std::chrono::nanoseconds period) noexcept;
  void publish_counts() noexcept;

  UdpSocket socket_;
  RdtEmulator<Endpoint> emulator_;
  Source source_;
  Endpoint local_;
  std::mutex posting_;  // of callers of `set`; the thread needs no lock
  Mailbox<EmulatorTrouble> trouble_;
  std::array<std::atomic<std::int64_t>, EmulatorCounts::fields().size()> published_{};
  rt::OnceThread thread_;  // last: it is joined before the others go
};

/// The newest force in a cell.
inline EmulatorServer::Source from_cell(std::shared_ptr<Mailbox<EmulatorServer::Force>> cell) {
  return [cell = std::move(cell), last = EmulatorServer::Force{}](double) mutable {
    if (const auto* force = cell->take()) last = *force;
    return last;
  };
}

}  // namespace ebac::sensor
