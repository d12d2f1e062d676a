#include "ebac/remote/link_end.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <random>

namespace ebac::remote {

namespace {

constexpr int kMostAtOnce = 256;                // datagrams in a tick
constexpr double kLongestTick = 10;             // s
constexpr std::uint32_t kSessions = 1'000'000;  // no hand consents more often
constexpr std::size_t kLastWords = 8;           // events kept for the other end's fault or end

std::int64_t now() EBAC_RT {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

teleop::Coupling watched(const LinkParams& params) {
  check(params, "LinkParams");
  return {.timeout = params.timeout, .fade = params.fade};
}

}  // namespace

LinkEnd::LinkEnd(Role role, const LinkParams& params, double dt, const sensor::Endpoint& at,
                 const std::optional<sensor::Endpoint>& peer)
    : slave_(role == Role::kSlave),
      params_(params),
      dt_(dt),
      watch_(watched(params), dt),
      socket_(at),
      peer_(peer),
      run_(slave_ ? 0 : std::random_device{}()) {
  told_ = {.from_slave = slave_,
           .session = session_,
           .run = run_};  // said by whoever leaves before its first tick
}

void LinkEnd::begin(double t, double elapsed) EBAC_RT {
  t_ = t;
  sensor::Datagram in;
  for (int i = 0; i < kMostAtOnce; ++i) {
    // An error tells that nobody listened to an earlier datagram: the silence is seen anyway.
    if (const int error = socket_.receive(in); error != 0) {
      if (error == EAGAIN) break;
      continue;
    }
    const auto packet = teleop::decode(in.bytes());
    if (!packet) {
      ++report_.refused;
    } else if (packet->from_slave == slave_) {
      receiver_.refuse();
    } else if (slave_ ? obeys(*packet) : belongs(*packet)) {
      if (slave_) peer_ = in.from;
      take(*packet);
    } else if (slave_ && bound_ && packet->run != run_ && watch_.lost()) {
      peer_ = in.from;  // a restarted master learns that its hand has to consent
    }
  }
  const teleop::LinkState before = watch_.state();
  if (consent_.exchange(false, std::memory_order_relaxed) || back_ > params_.consent_after) agree();
  // A loop that was held up is behind the clock, and so is not the silence.
  behind_ = std::min(behind_ + elapsed, kLongestTick);
  do {
    watch_.tick(other_lost_);
    behind_ -= dt_;
  } while (behind_ > 0.5 * dt_);
  back_ = watch_.state() == teleop::LinkState::kBack ? back_ + elapsed : 0.0;
  tell(before);
}

/// The master's rule: what belongs to its run and session.
bool LinkEnd::belongs(const teleop::Packet& packet) EBAC_RT {
  if (packet.run != run_ && packet.lost && packet.session >= session_ &&
      packet.session < session_ + kSessions) {
    slave_session_ = packet.session;  // a slave that an earlier run has left behind
    watch_.lose();
    watch_.heard();
  }
  if (packet.run == run_ && packet.session == session_) return true;
  receiver_.refuse();
  return false;
}

/// The slave's: one master, and another only after the link was lost and a hand has consented.
bool LinkEnd::obeys(const teleop::Packet& packet) EBAC_RT {
  const bool other = bound_ && packet.run != run_;
  if ((other ? !watch_.lost() : packet.session < session_) ||
      packet.session >= session_ + kSessions) {
    receiver_.refuse();
    return false;
  }
  if (other && packet.session <= session_) {
    receiver_.refuse();
    watch_.heard();
    return false;
  }
  if (packet.session > session_) {
    begin_session(packet.session);
    if (bound_)
      note(EventOf::kConsent, session_);  // a restarted slave joins a session it saw no consent to
  }
  bound_ = true;
  run_ = packet.run;
  // It has heard what this slave never sent: the slave was restarted.
  if (packet.echo > told_.sequence) watch_.lose();
  return true;
}

void LinkEnd::take(const teleop::Packet& packet) EBAC_RT {
  const std::int64_t sent = packet.echo > 0 ? sent_at_[packet.echo % sent_at_.size()] : 0;
  if (sent != 0 && !packet.leaving) {
    report_.round_trip = static_cast<double>(now() - sent) * 1e-9;
    report_.longest_round_trip = std::max(report_.longest_round_trip, report_.round_trip);
  }
  if ((packet.fault != 0 || packet.leaving) && !far_ended_) {
    far_ended_ = true;
    note(packet.fault != 0 ? EventOf::kFarFault : EventOf::kFarLeft, packet.fault);
  }
  other_lost_ = packet.lost;
  // What says goodbye does not come back.
  if (!far_ended_ && (watch_.lost() || receiver_.is_news(packet))) watch_.heard();
  receiver_.take(packet);
  heard_ = receiver_.play();
}

void LinkEnd::begin_session(std::uint32_t session) EBAC_RT {
  session_ = session;
  told_.sequence = 0;
  receiver_.reset();
  heard_ = {};
  watch_.begin();
  other_lost_ = far_ended_ = false;
  sent_at_.fill(0);
}

void LinkEnd::agree() EBAC_RT {
  if (slave_ || watch_.state() != teleop::LinkState::kBack) return;
  back_ = 0;
  begin_session(std::max(session_, slave_session_) + 1);
  note(EventOf::kConsent, session_);
}

void LinkEnd::tell(teleop::LinkState before) EBAC_RT {
  const teleop::LinkState state = watch_.state();
  if (far_ended_) return;  // has been told
  if (watch_.losses() > report_.losses) note(EventOf::kLost, watch_.silent());
  if (state == teleop::LinkState::kLost && before == teleop::LinkState::kWaiting &&
      watch_.losses() == report_.losses) {
    note(EventOf::kLost, watch_.silent());  // consented, but nobody answers
  }
  report_.losses = watch_.losses();
  if (state == before) return;
  if (state == teleop::LinkState::kRunning) note(EventOf::kRunning);
  if (state == teleop::LinkState::kBack) note(EventOf::kBack);
}

void LinkEnd::note(EventOf what, double value) EBAC_RT {
  const std::size_t i = events_.load(std::memory_order_relaxed);
  const bool last = what == EventOf::kFarFault || what == EventOf::kFarLeft;
  if (i >= (last ? kEvents : kEvents - kLastWords)) return;
  event_[i] = {.t = t_, .what = what, .value = value};
  events_.store(i + 1, std::memory_order_release);
}

void LinkEnd::end(const Four& value, const Four& at) EBAC_RT {
  const std::uint32_t fault = fault_.load(std::memory_order_relaxed);
  told_ = {.from_slave = slave_,
           .lost = watch_.lost() || fault != 0,
           .session = session_,
           .sequence = told_.sequence,
           .value = value[0],
           .energy = report_.energy_in,
           .run = run_,
           .fault = fault,
           .more = {value[1], value[2], value[3]},
           .at = at};
  send();
  report_.seconds = t_;
  report_.arrivals = receiver_.arrivals();
  report_.state = static_cast<int>(watch_.state());
  report_.session = static_cast<int>(session_);
  report_.away = watch_.away();
  shown_.post(report_);
}

void LinkEnd::send() EBAC_RT {
  ++told_.sequence;
  told_.echo = receiver_.newest();
  told_.stamp = now();
  sent_at_[told_.sequence % sent_at_.size()] = told_.stamp;
  if (!peer_) return;
  socket_.send(teleop::encode(told_), *peer_);
  ++report_.sent;
}

void LinkEnd::leave() noexcept {
  told_.lost = told_.leaving = true;
  told_.fault = fault_.load(std::memory_order_relaxed);
  send();
  shown_.post(report_);
}

LinkReport LinkEnd::look() {
  if (const LinkReport* newest = shown_.take()) last_ = *newest;
  return last_;
}

}  // namespace ebac::remote
