#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>

#include "ebac/core/check.hpp"
#include "ebac/loop/mailbox.hpp"
#include "ebac/sensor/udp.hpp"
#include "ebac/teleop/packet.hpp"
#include "ebac/teleop/session.hpp"

/// Master and slave on drives: the far side of a network as the world of a loop.
namespace ebac::remote {

/// Insertion, rotation, bend to the right, bend down [m, rad], or what loads them [N, N m].
using Four = std::array<double, 4>;

struct LinkParams {
  double timeout = 0.5;                                            // s
  double fade = 0.2;                                               // s
  double consent_after = std::numeric_limits<double>::infinity();  // s

  static constexpr auto fields() {
    using F = Field<LinkParams>;
    return std::array{
        F{"timeout", &LinkParams::timeout, "s", "silence after which the link counts as lost", 0.01,
          10},
        F{"fade", &LinkParams::fade, "s", "in which the master's force goes to zero and comes back",
          1e-3, 10},
        F{"consent_after", &LinkParams::consent_after, "s",
          "a simulated hand consents so long after the link is back; inf for never", 0},
    };
  }
};

/// What has happened at one end.
enum class EventOf : int {
  kNone = 0,      // nothing yet
  kRunning = 1,   // packets come: the force, or the slave, is let go
  kLost = 2,      // silence, or the other end has lost the link
  kBack = 3,      // packets come again; waits for consent
  kConsent = 4,   // a new session
  kFarLeft = 5,   // the other end has ended
  kFarFault = 6,  // its drives were stopped by a fault, which is the value
  kGroup = 7,     // slave: the other pair of drives has fallen silent
};

struct Event {
  double t = 0;  // s, since the loop began
  EventOf what = EventOf::kNone;
  double value = 0;
};

/// What an end has met since it was made. Four of a kind are in the order of the axes.
struct LinkReport {
  double seconds = 0;
  std::int64_t sent = 0;
  std::int64_t refused = 0;
  teleop::Arrivals arrivals{};
  std::int64_t losses = 0;
  int state = 0;
  int session = 1;
  double away = 0;
  double round_trip = 0;
  double longest_round_trip = 0;
  double energy_in = 0;
  double energy_out = 0;
  Four asked{};
  Four at{};
  Four error{};
  Four most_error{};
  Four load{};
  Four most_load{};
  double most_force = 0;
  double force_when_lost = 0;
  double moved_when_lost = 0;

  static constexpr auto fields() {
    using F = Field<LinkReport>;
    using R = LinkReport;
    return std::array{
        F{"seconds", &R::seconds, "s", "of the loop's ticks"},
        F{"sent", &R::sent, "1", "datagrams sent"},
        F{"refused", &R::refused, "1", "datagrams that are damaged, or of another protocol"},
        F{"losses", &R::losses, "1", "times the link was lost"},
        F{"state", &R::state, "1", "0 waiting, 1 running, 2 link lost, 3 link back"},
        F{"session", &R::session, "1", "the hand's consents so far, the first included"},
        F{"away", &R::away, "s", "time not running since the session began"},
        F{"round_trip", &R::round_trip, "s", "of the last packet that came back"},
        F{"longest_round_trip", &R::longest_round_trip, "s", "of all"},
        F{"energy_in", &R::energy_in, "J", "into the network at this end"},
        F{"energy_out", &R::energy_out, "J", "out of the network at this end"},
        F{"most_force", &R::most_force, "N", "largest force asked of an axis of the drives"},
        F{"force_when_lost", &R::force_when_lost, "N",
          "master: largest force asked while the link is lost and the fade is over"},
        F{"moved_when_lost", &R::moved_when_lost, "1",
          "slave: farthest a target has moved while the link is lost [m, rad]"},
    };
  }
};

/// One end of the link, called from the tick of one loop. Its rules are those of `teleop::Session`; the slave answers who
/// sends it good packets.
class LinkEnd {
 public:
  using Role = teleop::Role;

  /// The slave has no `peer`. Throws std::system_error where the port cannot be had, std::invalid_argument for a time-out
  /// within two ticks of `dt` [s].
  LinkEnd(Role role, const LinkParams& params, double dt, const sensor::Endpoint& at,
          const std::optional<sensor::Endpoint>& peer);

  // --- in the loop's thread ---

  /// Begin a tick at time `t` [s] of the loop, `elapsed` [s] after the last one.
  void begin(double t, double elapsed) EBAC_RT;
  /// End it: send what this side has to say.
  void end(const Four& value, const Four& at) EBAC_RT;
  void note(EventOf what, double value = 0) EBAC_RT;

  bool running() const EBAC_RT { return watch().state() == teleop::LinkState::kRunning; }
  bool lost() const EBAC_RT { return watch().lost(); }
  double share() const EBAC_RT { return watch().share(); }
  std::uint32_t session() const EBAC_RT { return session_.number(); }
  /// The newest of this session; sequence 0 before the first.
  const teleop::Packet& heard() const EBAC_RT { return heard_; }
  LinkReport& report() EBAC_RT { return report_; }
  /// This side cannot go on in this session.
  void lose() EBAC_RT { session_.lose(); }

  // --- from any one other thread ---

  /// The hand agrees to go on after the link was lost.
  void consent() noexcept { consent_.store(true, std::memory_order_relaxed); }
  /// The drives here have stopped by a fault: the other side hears it with every packet.
  void fail(std::uint32_t fault) noexcept { fault_.store(fault, std::memory_order_relaxed); }
  /// After the loop has ended: informs the other side, once.
  void leave() noexcept;
  /// What it has met, as of the loop's last tick.
  LinkReport look();
  std::size_t events() const noexcept { return events_.load(std::memory_order_acquire); }
  Event event(std::size_t i) const noexcept { return event_[i]; }
  static constexpr std::size_t kEvents = 1024;  // later ones are counted by the report alone
  sensor::Endpoint local() const noexcept { return socket_.local(); }

 private:
  const teleop::LinkWatch& watch() const EBAC_RT { return session_.watch(); }
  void hear(const teleop::Packet& packet, const sensor::Endpoint& from) EBAC_RT;
  void take(const teleop::Packet& packet) EBAC_RT;
  void begin_session() EBAC_RT;
  void agree() EBAC_RT;
  void tell(const teleop::LinkState before) EBAC_RT;
  void send() EBAC_RT;

  bool slave_;
  LinkParams params_;
  double dt_;
  teleop::Session session_;
  sensor::UdpSocket socket_;
  std::optional<sensor::Endpoint> peer_;
  teleop::Packet heard_{};
  teleop::Packet sent_{};  // the last one sent
  bool far_ended_ = false;
  double t_ = 0;                              // s
  double back_ = 0;                           // s, since the link is back
  double behind_ = 0;                         // s, for the watch
  std::array<std::int64_t, 4096> sent_at_{};  // ns, by sequence number
  LinkReport report_{};
  Mailbox<LinkReport> shown_{};
  LinkReport last_{};  // of whoever looks
  std::atomic<bool> consent_{false};
  std::atomic<std::uint32_t> fault_{0};
  std::array<Event, kEvents> event_{};
  std::atomic<std::size_t> events_{0};
};

}  // namespace ebac::remote
