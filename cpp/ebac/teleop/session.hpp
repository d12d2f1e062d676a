#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ebac/core/realtime.hpp"
#include "ebac/teleop/coupling.hpp"
#include "ebac/teleop/link_watch.hpp"
#include "ebac/teleop/packet.hpp"
#include "ebac/teleop/receiver.hpp"

namespace ebac::teleop {

enum class Role { kMaster, kSlave };

/// What becomes of a packet.
enum class Heed {
  kRefused,   // not one of this session
  kAnswered,  // not used, but its sender is to learn that its hand has to consent, or of the scheme
  kTaken,
  kBegun,  // taken, the first of a session that this side did not know
};

/// The rules of session, run and restart of one side, whatever it moves: a lost link needs a hand's
/// consent at the master, and so does a master or a slave that was restarted.
class Session {
 public:
  /// `run` is the master's own number; a slave takes that of its master.
  Session(Role role, const Coupling& coupling, double dt, std::uint32_t run = 0) EBAC_RT
      : slave_(role == Role::kSlave),
        watch_(coupling, dt),
        receiver_(static_cast<int>(std::lround(coupling.buffer / dt))),
        run_(run),
        scheme_(coupling.scheme) {}

  Heed judge(const Packet& packet) EBAC_RT {
    if (packet.from_slave == slave_) return refused();
    if (packet.scheme != scheme_) {
      ++other_scheme_;
      receiver_.refuse();
      return slave_ && !bound_ ? Heed::kAnswered : Heed::kRefused;
    }
    return slave_ ? obey(packet) : belong(packet);
  }
  /// A packet that counts. `alive`: whether it may be a sign of life.
  void take(const Packet& packet, bool alive = true) EBAC_RT {
    other_lost_ = packet.lost;
    if (alive && (watch_.lost() || receiver_.is_news(packet))) watch_.heard();
    receiver_.take(packet);
  }
  /// At the end of a tick.
  void tick() EBAC_RT { watch_.tick(other_lost_); }
  /// What counts now; all zero before the first packet.
  Packet play() EBAC_RT { return receiver_.play(); }
  /// The hand at the master agrees to go on after the link was lost: a new session. False where the
  /// link is not back.
  bool consent() EBAC_RT {
    if (slave_ || watch_.state() != LinkState::kBack) return false;
    begin(std::max(number_, slave_number_) + 1);
    return true;
  }
  /// This side cannot go on in this session.
  void lose() EBAC_RT { watch_.lose(); }
  /// Of the next packet to send.
  std::uint32_t next() EBAC_RT { return ++sequence_; }

  std::uint32_t number() const EBAC_RT { return number_; }
  std::uint32_t run() const EBAC_RT { return run_; }
  bool bound() const EBAC_RT { return bound_; }  // a slave, to that run
  /// Packets that were refused because the other side has another scheme.
  std::int64_t other_scheme() const EBAC_RT { return other_scheme_; }
  const LinkWatch& watch() const EBAC_RT { return watch_; }
  const Receiver& receiver() const EBAC_RT { return receiver_; }

 private:
  static constexpr std::uint32_t kMostConsents = 1'000'000;  // no hand consents more often

  Heed refused() EBAC_RT {
    receiver_.refuse();
    return Heed::kRefused;
  }

  /// The master: what belongs to its run and session.
  Heed belong(const Packet& packet) EBAC_RT {
    if (packet.run != run_ && packet.lost && packet.session >= number_ &&
        packet.session < number_ + kMostConsents) {
      slave_number_ = packet.session;  // a slave that an earlier run has left behind
      watch_.lose();
      watch_.heard();
    }
    return packet.run == run_ && packet.session == number_ ? Heed::kTaken : refused();
  }

  /// The slave: one master. Another one, which was restarted, is heard only after this one's link is
  /// lost, and obeyed only from a session on that a hand has consented to.
  Heed obey(const Packet& packet) EBAC_RT {
    const bool other = bound_ && packet.run != run_;
    if ((other ? !watch_.lost() : packet.session < number_) ||
        packet.session >= number_ + kMostConsents) {
      return refused();
    }
    if (other && packet.session <= number_) {
      receiver_.refuse();
      watch_.heard();
      return Heed::kAnswered;
    }
    const bool begun = packet.session > number_;
    if (begun) begin(packet.session);
    bound_ = true;
    run_ = packet.run;
    // It has heard what this slave never sent: the slave was restarted.
    if (packet.echo > sequence_) watch_.lose();
    return begun ? Heed::kBegun : Heed::kTaken;
  }

  void begin(std::uint32_t number) EBAC_RT {
    number_ = number;
    sequence_ = 0;
    receiver_.reset();
    watch_.begin();
    other_lost_ = false;
  }

  bool slave_;
  LinkWatch watch_;
  Receiver receiver_;
  std::uint32_t number_ = 1;
  std::uint32_t sequence_ = 0;  // of the last packet sent
  std::uint32_t run_;           // of the master
  bool bound_ = false;
  int scheme_;
  std::int64_t other_scheme_ = 0;
  std::uint32_t slave_number_ = 0;  // of a slave that belongs to another run
  bool other_lost_ = false;
};

}  // namespace ebac::teleop
