#include "ebac/remote/link_end.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "ebac/core/six_digits.hpp"

namespace ebac::remote {

namespace {

constexpr int kMostAtOnce = 256;       // datagrams in a tick
constexpr double kLongestTick = 10;    // s
constexpr std::size_t kLastWords = 8;  // events kept for the other end's fault or end

std::int64_t now() EBAC_RT {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

teleop::Coupling watched(const LinkParams& params, double dt) {
  check(params, "FarLink");
  if (!(params.timeout > 2 * dt)) {
    throw std::invalid_argument("FarLink.timeout = " + shortest(params.timeout) +
                                " s: must be longer than two ticks of the loop, " +
                                six_digits(2 * dt) + " s, or no link would ever run");
  }
  return {.timeout = params.timeout, .fade = params.fade};
}

}  // namespace

LinkEnd::LinkEnd(Role role, const LinkParams& params, double dt, const sensor::Endpoint& at,
                 const std::optional<sensor::Endpoint>& peer)
    : slave_(role == Role::kSlave),
      params_(params),
      dt_(dt),
      session_(role, watched(params, dt), dt, slave_ ? 0 : std::random_device{}()),
      socket_(at),
      peer_(peer) {
  sent_ = {.from_slave = slave_,
           .session = session_.number(),
           .run = session_.run()};  // said by whoever leaves before its first tick
}

void LinkEnd::begin(double t, double elapsed) EBAC_RT {
  t_ = t;
  sensor::Datagram in;
  for (int i = 0; i < kMostAtOnce; ++i) {
    // An error shows that nobody listened to an earlier datagram: the silence is seen anyway.
    if (const int error = socket_.receive(in); error != 0) {
      if (error == EAGAIN) break;
      continue;
    }
    if (const auto packet = teleop::decode(in.bytes())) {
      hear(*packet, in.from);
    } else {
      ++report_.refused;
    }
  }
  const teleop::LinkState before = watch().state();
  if (consent_.exchange(false, std::memory_order_relaxed) || back_ > params_.consent_after) agree();
  // A loop that was held up is behind the clock, and so is not the silence.
  behind_ = std::min(behind_ + elapsed, kLongestTick);
  do {
    session_.tick();
    behind_ -= dt_;
  } while (behind_ > 0.5 * dt_);
  back_ = watch().state() == teleop::LinkState::kBack ? back_ + elapsed : 0.0;
  tell(before);
}

void LinkEnd::hear(const teleop::Packet& packet, const sensor::Endpoint& from) EBAC_RT {
  const bool bound = session_.bound();
  const teleop::Heed heed = session_.judge(packet);
  if (heed == teleop::Heed::kRefused) return;
  if (slave_) peer_ = from;
  if (heed == teleop::Heed::kAnswered) return;
  if (heed == teleop::Heed::kBegun) {
    begin_session();
    if (bound) note(EventOf::kConsent, session_.number());  // a restarted slave saw none
  }
  take(packet);
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
  session_.take(packet, /*alive=*/!far_ended_);  // what says goodbye does not come back
  heard_ = session_.play();
}

void LinkEnd::begin_session() EBAC_RT {
  heard_ = {};
  far_ended_ = false;
  sent_at_.fill(0);
}

void LinkEnd::agree() EBAC_RT {
  if (!session_.consent()) return;
  back_ = 0;
  begin_session();
  note(EventOf::kConsent, session_.number());
}

void LinkEnd::tell(teleop::LinkState before) EBAC_RT {
  const teleop::LinkState state = watch().state();
  if (far_ended_) return;  // it knows
  if (watch().losses() > report_.losses) note(EventOf::kLost, watch().silent());
  if (state == teleop::LinkState::kLost && before == teleop::LinkState::kWaiting &&
      watch().losses() == report_.losses) {
    note(EventOf::kLost, watch().silent());  // consented, but nobody answers
  }
  report_.losses = watch().losses();
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
  sent_ = {.from_slave = slave_,
           .lost = watch().lost() || fault != 0,
           .session = session_.number(),
           .value = value[0],
           .energy = report_.energy_in,
           .run = session_.run(),
           .fault = fault,
           .more = {value[1], value[2], value[3]},
           .at = at};
  send();
  report_.seconds = t_;
  report_.arrivals = session_.receiver().arrivals();
  report_.state = static_cast<int>(watch().state());
  report_.session = static_cast<int>(session_.number());
  report_.away = watch().away();
  shown_.post(report_);
}

void LinkEnd::send() EBAC_RT {
  sent_.sequence = session_.next();
  sent_.echo = session_.receiver().newest();
  sent_.stamp = now();
  sent_at_[sent_.sequence % sent_at_.size()] = sent_.stamp;
  if (!peer_) return;
  socket_.send(teleop::encode(sent_), *peer_);
  ++report_.sent;
}

void LinkEnd::leave() noexcept {
  sent_.lost = sent_.leaving = true;
  sent_.fault = fault_.load(std::memory_order_relaxed);
  send();
  shown_.post(report_);
}

LinkReport LinkEnd::look() {
  if (const LinkReport* newest = shown_.take()) last_ = *newest;
  return last_;
}

}  // namespace ebac::remote
