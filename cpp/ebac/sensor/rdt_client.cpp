#include "ebac/sensor/rdt_client.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <stdexcept>

namespace ebac::sensor {

namespace {

const RdtClientSetup& checked_setup(const RdtClientSetup& setup) {
  check_client(setup);
  return setup;
}

/// A socket where packets of the sensor can arrive: on loopback for one on this machine.
UdpSocket socket_for(const Endpoint& sensor) {
  const bool here = sensor.address >> 24U == kLoopbackAddress >> 24U;
  return UdpSocket({.address = here ? kLoopbackAddress : 0});
}

template <class Clock>
std::int64_t now() EBAC_RT {  // ns
  return std::chrono::nanoseconds(Clock::now().time_since_epoch()).count();
}

}  // namespace

double record_age(std::int64_t stamp, std::int64_t wall, std::int64_t since_poll) EBAC_RT {
  return static_cast<double>(std::clamp<std::int64_t>(wall - stamp, 0, since_poll)) * 1e-9;
}

void check_client(const RdtClientSetup& setup) {
  if (setup.sensor.port == 0) {
    throw std::invalid_argument("sensor.port = 0: must lie in [1, 65535]; a Net F/T has 49152");
  }
  const auto within = [](const char* name, double value) {
    if (value >= 1e-3 && value <= 60) return;
    throw std::invalid_argument(range_message("sensor", name, value, "s", 1e-3, 60));
  };
  within("retry", setup.retry);
  within("gone", setup.gone);
}

RdtClient::RdtClient(const RdtClientSetup& setup)
    : setup_(checked_setup(setup)), link_(setup.link), socket_(socket_for(setup.sensor)) {}

void RdtClient::ask(RdtCommand command) EBAC_RT {
  const RdtRequest request{.command = static_cast<std::uint16_t>(command)};
  const int error = open() ? socket_.send(encode(request), setup_.sensor) : EBADF;
  if (error != 0) {
    ++refused_;
    note(error);
  }
}

void RdtClient::start() EBAC_RT {
  if (!open()) return;
  Datagram old;  // packets in the queue belong to another stream of unknown age
  for (int i = 0; i < kMostPackets && socket_.receive(old) != EAGAIN; ++i) {
  }
  wanted_ = true;
  state_ = LinkState::kWaiting;
  age_ = quiet_ = since_asked_ = 0;
  ++asked_;
  link_.restart();
  ask(RdtCommand::kStart);
}

void RdtClient::stop() EBAC_RT {
  if (!open()) return;
  wanted_ = false;
  ask(RdtCommand::kStop);
  state_ = LinkState::kStopped;
}

void RdtClient::close() noexcept {
  if (wanted_) stop();
  if (open()) socket_.end_waits();
  state_ = LinkState::kClosed;
}

bool RdtClient::poll(double elapsed) EBAC_RT {
  age_ += elapsed;
  quiet_ += elapsed;
  since_asked_ += elapsed;
  const std::int64_t polled = now<std::chrono::steady_clock>();
  since_poll_ = polled - polled_;
  polled_ = polled;
  bool newer = false;
  Datagram in;
  for (int i = 0; i < kMostPackets && open(); ++i) {
    const int error = socket_.receive(in);
    if (error == EAGAIN) break;
    if (error != 0) {
      note(error);
    } else {
      newer = take(in) || newer;
    }
  }
  if (!newer && state_ == LinkState::kStreaming && quiet_ > setup_.gone)
    state_ = LinkState::kSilent;
  if (wanted_ && std::min(quiet_, since_asked_) > setup_.retry) {  // it may have lost its power
    since_asked_ = 0;
    ++asked_;
    link_.restart();
    ask(RdtCommand::kStart);
  }
  fill_row();
  return newer;
}

bool RdtClient::take(const Datagram& in) EBAC_RT {
  if (in.from != setup_.sensor) {
    ++foreign_;
    return false;
  }
  if (!link_.take(in.bytes())) return false;
  const std::int64_t wall = now<std::chrono::system_clock>();
  age_ = setup_.stamped && in.stamp != 0 ? record_age(in.stamp, wall, since_poll_) : 0;
  quiet_ = 0;
  if (wanted_) state_ = LinkState::kStreaming;
  return true;
}

/// State of the connection after a failed call.
void RdtClient::note(int error) EBAC_RT {
  if (!wanted_) return;
  state_ = error == ECONNREFUSED ? LinkState::kRefused : LinkState::kUnreachable;
}

SensorStatus RdtClient::health() const EBAC_RT {
  const bool gone = state_ != LinkState::kStreaming || age_ > setup_.gone;
  return gone ? SensorStatus::kDisconnected : link_.health();
}

void RdtClient::fill(Reading& reading) const EBAC_RT {
  const Axes force = link_.force();
  for (std::size_t i = 0; i < kMaxAxes; ++i) {
    reading.force[i] = force[static_cast<Eigen::Index>(i)];
  }
  reading.force_age = age_;
  reading.force_status = health();
}

void RdtClient::fill_row() EBAC_RT {
  const Axes torque = link_.torque();
  for (std::size_t i = 0; i < kMaxAxes; ++i) {
    row_[i] = {.torque = torque[static_cast<Eigen::Index>(i)],
               .age = age_,
               .status = link_.record().status,
               .received = link_.received(),
               .lost = link_.order().lost(),
               .late = link_.order().late(),
               .duplicate = link_.order().duplicate(),
               .malformed = link_.malformed(),
               .foreign = foreign_};
  }
}

}  // namespace ebac::sensor
