#include "ebac/teleop/udp_sides.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>

#include "ebac/core/six_digits.hpp"

namespace ebac::teleop {

namespace {

constexpr std::int64_t kTick = 1'000'000;      // ns
constexpr std::int64_t kMadeUp = 100'000'000;  // ns, so many late ticks are made up
constexpr double kSecond = 1e-3;               // s a tick
constexpr int kMostAtOnce = 256;               // datagrams in a tick
constexpr double kSettled = 0.05;              // s, after the fade: command and motor lag

std::int64_t now() noexcept {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Calls `take` for every datagram that waits.
template <class Take>
void receive_all(sensor::UdpSocket& socket, Take take) noexcept {
  sensor::Datagram in;
  for (int i = 0; i < kMostAtOnce; ++i) {
    // An error shows that nobody listened to an earlier datagram: the silence is seen anyway.
    if (const int error = socket.receive(in); error != 0) {
      if (error == EAGAIN) return;
      continue;
    }
    take(in);
  }
}

/// Ticks for `seconds`.
template <class Tick>
void run_for(double seconds, Pace& pace, Report& report, Tick tick) noexcept {
  const auto ticks = std::llround(seconds / kSecond);
  for (std::int64_t i = 0; i < ticks; ++i) {
    const double late = pace.wait();
    if (late > kSecond) ++report.late_ticks;
    report.latest = std::max(report.latest, late);
    tick();
    report.seconds += kSecond;
  }
}

/// Keeps the largest force, and when it was: how long after the link began to run.
template <class Side>
void hold_most(const Side& side, double& running, Report& report) EBAC_RT {
  running = side.watch().state() == LinkState::kRunning ? running + kSecond : 0.0;
  if (std::abs(report.force) <= report.most_force) return;
  report.most_force = std::abs(report.force);
  report.most_force_at = report.seconds;
  report.most_force_since = running;
}

template <class Side>
void describe(const Side& side, Report& report) EBAC_RT {
  report.arrivals = side.receiver().arrivals();
  report.losses = side.watch().losses();
  report.other_scheme = side.other_scheme();
  report.state = static_cast<int>(side.watch().state());
  report.session = static_cast<int>(side.session());
  report.away = side.watch().away();
}

}  // namespace

double Pace::wait() noexcept {
  if (next_ == 0) next_ = now();
  next_ += kTick;
  const std::int64_t left = next_ - now();
  if (left > 0) std::this_thread::sleep_for(std::chrono::nanoseconds(left));
  const std::int64_t late = now() - next_;
  if (late > kMadeUp) next_ += late;
  return std::max(0.0, static_cast<double>(late) * 1e-9);
}

UdpMaster::UdpMaster(const Setup& setup, const AnyLaw& law, const Coupling& coupling,
                     const sensor::Endpoint& at, const sensor::Endpoint& peer, double consent_after)
    : side_(setup, law, coupling, std::random_device{}()),
      socket_(at),
      peer_(peer),
      consent_after_(consent_after) {
  if (setup.timing.dt == kSecond) return;
  throw std::invalid_argument("Timing.dt = " + six_digits(setup.timing.dt) +
                              " s: master, network and slave as processes run at 1 kHz; must be " +
                              six_digits(kSecond) + " s, another rate is simulated only");
}

Report UdpMaster::run(double seconds) noexcept {
  run_for(seconds, pace_, report_, [this] { tick(); });
  describe(side_, report_);
  return report_;
}

void UdpMaster::measure(const Packet& packet) EBAC_RT {
  const std::int64_t sent = packet.echo > 0 ? sent_at_[packet.echo % sent_at_.size()] : 0;
  if (sent == 0 || packet.session != side_.session()) return;
  report_.round_trip = static_cast<double>(now() - sent) * 1e-9;
  report_.longest_round_trip = std::max(report_.longest_round_trip, report_.round_trip);
}

void UdpMaster::tick() EBAC_RT {
  receive_all(socket_, [this](const sensor::Datagram& in) {
    const auto packet = decode(in.bytes());
    if (!packet) {
      ++report_.refused;
      return;
    }
    measure(*packet);
    side_.take(*packet);
  });
  back_ = side_.watch().state() == LinkState::kBack ? back_ + kSecond : 0.0;
  if (consent_.exchange(false, std::memory_order_relaxed) || back_ > consent_after_) {
    side_.consent();
  }
  const Packet out = side_.step(now());
  sent_at_[out.sequence % sent_at_.size()] = out.stamp;
  socket_.send(encode(out), peer_);
  ++report_.sent;
  report_.position = side_.device_port().x;
  report_.farthest = std::max(report_.farthest, std::abs(report_.position));
  report_.force = side_.device_port().f_applied;
  hold_most(side_, running_, report_);
  calm_ = side_.watch().share() == 0 ? calm_ + kSecond : 0.0;
  if (calm_ > kSettled) {
    report_.force_when_lost = std::max(report_.force_when_lost, std::abs(report_.force));
  }
  report_.fault = side_.sample().fault;
  is_back_.store(side_.watch().state() == LinkState::kBack, std::memory_order_relaxed);
}

UdpSlave::UdpSlave(const SlaveModel& model, const Coupling& coupling, const sensor::Endpoint& at)
    : side_(model, coupling, kSecond), socket_(at) {}

Report UdpSlave::run(double seconds) noexcept {
  run_for(seconds, pace_, report_, [this] { tick(); });
  describe(side_, report_);
  return report_;
}

void UdpSlave::tick() EBAC_RT {
  receive_all(socket_, [this](const sensor::Datagram& in) {
    const auto packet = decode(in.bytes());
    if (!packet) {
      ++report_.refused;
      return;
    }
    if (side_.take(*packet)) peer_ = in.from;
  });
  const Packet out = side_.step(now());
  const SlaveSide::State& state = side_.state();
  const bool holds = out.lost;
  if (holds && !holds_) held_ = state.target;
  holds_ = holds;
  if (holds) {
    report_.moved_when_lost = std::max(report_.moved_when_lost, std::abs(state.target - held_));
  }
  report_.position = state.x;
  report_.farthest = std::max(report_.farthest, std::abs(report_.position));
  report_.force = state.force;
  hold_most(side_, running_, report_);
  if (!peer_) return;
  socket_.send(encode(out), *peer_);
  ++report_.sent;
}

UdpNetwork::UdpNetwork(const Link& there, const Link& back, std::uint64_t seed,
                       const sensor::Endpoint& at, const sensor::Endpoint& slave)
    : socket_(at),
      slave_(slave),
      there_(there, kSecond, seed, /*stream=*/11),
      back_(back, kSecond, seed, /*stream=*/12),
      bits_(seed, /*stream=*/13) {}

Report UdpNetwork::run(double seconds) noexcept {
  run_for(seconds, pace_, report_, [this] { tick(); });
  return report_;
}

void UdpNetwork::tick() noexcept {
  receive_all(socket_, [this](const sensor::Datagram& in) {
    ++report_.arrivals.received;
    const bool from_slave = in.from == slave_;
    if (!from_slave) master_ = in.from;
    Item item{.data = in.data, .size = in.size};
    Channel<Item>& way = from_slave ? back_ : there_;
    const bool passed = !cut_.load(std::memory_order_relaxed) && item.size > 0 && way.send(item);
    if (!passed) ++report_.arrivals.missing;
    if (passed && way.hit()) {
      const std::uint64_t bit = bits_.bits() % (8 * item.size);
      way.newest().data[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
      ++report_.refused;
    }
  });
  const auto pass = [this](const sensor::Endpoint& to) {
    return [this, to](const Item& item) {
      socket_.send(std::span(item.data).first(item.size), to);
      ++report_.sent;
    };
  };
  there_.deliver(pass(slave_));
  back_.deliver(pass(master_.value_or(slave_)));
}

}  // namespace ebac::teleop
