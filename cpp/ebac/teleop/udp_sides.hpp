#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>

#include "ebac/sensor/udp.hpp"
#include "ebac/teleop/channel.hpp"
#include "ebac/teleop/master.hpp"
#include "ebac/teleop/slave.hpp"

/// Master, slave and network as processes of their own, over UDP, at 1 kHz. Each runs for some time in the
/// caller's thread; master and slave allocate nothing meanwhile.
namespace ebac::teleop {

/// What a process has met since it was made.
struct Report {
  double seconds = 0;
  std::int64_t sent = 0;
  std::int64_t refused = 0;
  std::int64_t other_scheme = 0;
  Arrivals arrivals{};
  std::int64_t losses = 0;
  int state = 0;
  int session = 1;
  double away = 0;
  double round_trip = 0;
  double longest_round_trip = 0;
  double position = 0;
  double farthest = 0;
  double force = 0;
  double most_force = 0;
  double most_force_at = 0;
  double most_force_since = 0;
  double force_when_lost = 0;
  double moved_when_lost = 0;
  std::int64_t late_ticks = 0;
  double latest = 0;
  Fault fault = Fault::kNone;

  static constexpr auto fields() {
    using F = Field<Report>;
    return std::array{
        F{"seconds", &Report::seconds, "s", "of ticks done"},
        F{"sent", &Report::sent, "1", "datagrams sent"},
        F{"refused", &Report::refused, "1", "datagrams that are damaged, or of another protocol"},
        F{"other_scheme", &Report::other_scheme, "1",
          "datagrams refused because their sender has another scheme"},
        F{"losses", &Report::losses, "1", "times the link was lost"},
        F{"state", &Report::state, "1", "0 waiting, 1 running, 2 link lost, 3 link back"},
        F{"session", &Report::session, "1", "the hand's consents so far, the first included"},
        F{"away", &Report::away, "s", "time not running since the session began"},
        F{"round_trip", &Report::round_trip, "s", "of the last packet that came back"},
        F{"longest_round_trip", &Report::longest_round_trip, "s", "of all"},
        F{"position", &Report::position, "m", "of this side now"},
        F{"farthest", &Report::farthest, "m", "largest distance of this side from where it began"},
        F{"force", &Report::force, "N", "of this side now"},
        F{"most_force", &Report::most_force, "N", "largest force of this side"},
        F{"most_force_at", &Report::most_force_at, "s", "when that was first reached"},
        F{"most_force_since", &Report::most_force_since, "s",
          "how long the link had been running again then"},
        F{"force_when_lost", &Report::force_when_lost, "N",
          "master: largest force of its motor while the link is lost and the fade is over"},
        F{"moved_when_lost", &Report::moved_when_lost, "m",
          "slave: farthest its target has moved while the link is lost"},
        F{"late_ticks", &Report::late_ticks, "1", "ticks that began more than 1 ms late"},
        F{"latest", &Report::latest, "s", "the latest of them"},
        F{"fault", &Report::fault, "1", "of the master's chain"},
    };
  }
};

/// Ticks of 1 ms by the system's clock. A late tick is made up for, so that simulated time goes as the clock does.
class Pace {
 public:
  /// Waits for the next tick; returns how late it is [s]. After a longer stall, or a pause between two runs, the clock
  /// begins anew: the ticks that were missed would come in one burst.
  double wait() noexcept;

 private:
  std::int64_t next_ = 0;  // ns
};

class UdpMaster {
 public:
  UdpMaster(const Setup& setup, const AnyLaw& law, const Coupling& coupling,
            const sensor::Endpoint& at, const sensor::Endpoint& peer, double consent_after);

  Report run(double seconds) noexcept;
  /// The hand agrees to go on, from the next tick on; false where the link is not back. From any
  /// thread.
  bool consent() noexcept {
    const bool back = is_back_.load(std::memory_order_relaxed);
    if (back) consent_.store(true, std::memory_order_relaxed);
    return back;
  }
  sensor::Endpoint local() const noexcept { return socket_.local(); }

 private:
  void tick() EBAC_RT;
  void measure(const Packet& packet) EBAC_RT;

  MasterSide side_;
  sensor::UdpSocket socket_;
  sensor::Endpoint peer_;
  double consent_after_;                      // s
  std::atomic<bool> is_back_{false};          // the link, at the end of the last tick
  std::atomic<bool> consent_{false};          // given since
  double back_ = 0;                           // s, since the link is back
  double calm_ = 0;                           // s, since the fade ended
  double running_ = 0;                        // s, since the link began to run
  std::array<std::int64_t, 4096> sent_at_{};  // ns, by sequence number
  Pace pace_;
  Report report_{};
};

class UdpSlave {
 public:
  UdpSlave(const SlaveModel& model, const Coupling& coupling, const sensor::Endpoint& at);

  Report run(double seconds) noexcept;
  sensor::Endpoint local() const noexcept { return socket_.local(); }

 private:
  void tick() EBAC_RT;

  SlaveSide side_;
  sensor::UdpSocket socket_;
  std::optional<sensor::Endpoint> peer_;  // who sent the last good packet
  double held_ = 0;                       // m, target when the link was lost
  bool holds_ = false;
  double running_ = 0;  // s, since the link began to run
  Pace pace_;
  Report report_{};
};

/// Between the two: delays, drops, reorders and damages datagrams, without reading them.
class UdpNetwork {
 public:
  UdpNetwork(const Link& there, const Link& back, std::uint64_t seed, const sensor::Endpoint& at,
             const sensor::Endpoint& slave);

  Report run(double seconds) noexcept;
  sensor::Endpoint local() const noexcept { return socket_.local(); }
  /// Cuts both ways, or mends them; from any thread.
  void cut(bool on) noexcept { cut_.store(on, std::memory_order_relaxed); }

 private:
  struct Item {
    std::array<std::uint8_t, sensor::Datagram::kRoom> data{};
    std::size_t size = 0;
  };
  void tick() noexcept;

  sensor::UdpSocket socket_;
  sensor::Endpoint slave_;
  std::optional<sensor::Endpoint> master_;
  Channel<Item> there_;
  Channel<Item> back_;
  Noise bits_;
  std::atomic<bool> cut_{false};
  Pace pace_;
  Report report_{};
};

}  // namespace ebac::teleop
