#include "ebac/simulated_drives/simulated_wire.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ebac/can/frame_length.hpp"
#include "ebac/core/check.hpp"

namespace ebac::can {

namespace {

void check_range(const char* name, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(range_message("SimulatedWire", name, value, unit, low, high));
}

}  // namespace

SimulatedWire::SimulatedWire(const WireOptions& options)
    : bit_(1e9 / options.bit_rate), random_(options.seed, /*stream=*/3) {
  check_range("stations", static_cast<double>(options.stations), 1, 256, "1");
  check_range("bit_rate", options.bit_rate, 1e4, 1e6, "bit/s");
  check_range("error_rate", options.error_rate, 0, 1, "1");
  station_.resize(options.stations);
  for (Station& one : station_) {
    one.error_rate = options.error_rate;
    one.recovers = options.recovers;
  }
}

std::int64_t SimulatedWire::time_of(std::int64_t bits) const EBAC_RT {
  return std::llround(bit_ * static_cast<double>(bits));
}

bool SimulatedWire::send(std::size_t station, const Frame& frame, std::int64_t due) EBAC_RT {
  Station& from = station_[station];
  if (from.off || !sendable(frame) || due > kLatest) return false;
  Frame out = frame;
  out.stamp = due;
  return from.queue.push(out);
}

BusState SimulatedWire::state(std::size_t station) const EBAC_RT {
  const Station& one = station_[station];
  const int most = std::max(one.sent_errors, one.received_errors);
  if (one.off) return BusState::kBusOff;
  if (most > kPassive) return BusState::kPassive;
  return most > kWarning ? BusState::kWarning : BusState::kUp;
}

/// From when on it could send.
std::optional<std::int64_t> SimulatedWire::Station::ready() const EBAC_RT {
  const Frame* first = queue.front();
  if (off || first == nullptr) return std::nullopt;
  return std::max(first->stamp, free_at);
}

bool SimulatedWire::next(std::int64_t until, Delivery& delivery) EBAC_RT {
  until = std::min(until, kLatest);
  for (;;) {
    if (!under_way_ && !start(until)) return false;
    if (ends_ > until) return false;
    under_way_ = false;
    now_ = ends_;
    if (end(delivery)) return true;
  }
}

/// Puts the frame that wins the arbitration on the wire; false where none waits before `until`.
bool SimulatedWire::start(std::int64_t until) EBAC_RT {
  std::int64_t at = until;
  for (const Station& one : station_) {
    if (const auto ready = one.ready()) at = std::min(at, std::max(*ready, now_));
  }
  if (at > now_) {
    idle_ += at - now_;
    const auto bits = static_cast<std::int64_t>(static_cast<double>(idle_) / bit_);
    idle_ -= time_of(bits);
    recover(bits);
    now_ = at;
  }
  if (now_ >= until) return false;
  const Frame* best = nullptr;
  for (std::size_t i = 0; i < station_.size(); ++i) {
    const auto ready = station_[i].ready();
    if (!ready || *ready > now_) continue;
    const Frame* mine = station_[i].queue.front();
    if (best != nullptr && priority(*best) <= priority(*mine)) continue;
    best = mine;
    sender_ = i;
  }
  if (best == nullptr) return false;  // one that has just come back has none
  const double rate = station_[sender_].error_rate;
  const int whole = exact_bits(*best);
  const bool hit = rate > 0 && 0.5 + 0.5 * random_.symmetric() < rate;
  heard_ = !hit && acknowledged();
  int bits = whole;
  if (!heard_) {
    constexpr int kEarliest = 20;          // bits: what came before decided the arbitration
    constexpr int kAfterSlot = 1 + 7 + 3;  // bits after the acknowledgement
    const auto span = static_cast<std::uint64_t>(whole - kEarliest);
    bits = hit ? kEarliest + static_cast<int>(random_.bits() % span) : whole - kAfterSlot;
    bits += kErrorFrame;
  }
  ends_ = now_ + time_of(bits);
  busy_ += time_of(bits);
  under_way_ = true;
  return true;
}

bool SimulatedWire::acknowledged() const EBAC_RT {
  for (std::size_t i = 0; i < station_.size(); ++i) {
    if (i != sender_ && !station_[i].off) return true;
  }
  return false;
}

/// The wire is free again; true where a frame has arrived.
bool SimulatedWire::end(Delivery& delivery) EBAC_RT {
  Station& sender = station_[sender_];
  idle_ = 0;
  if (sender.passive()) sender.free_at = now_ + time_of(kSuspend);
  if (!heard_) {
    destroy(sender);
    return false;
  }
  recover(kRecessive);  // the end of a frame and the space after it
  sender.queue.pop(delivery.frame);
  delivery.frame.stamp = now_;
  delivery.from = sender_;
  for (Station& one : station_) {
    int& errors = &one == &sender ? one.sent_errors : one.received_errors;
    errors = std::max(0, errors - 1);
  }
  return true;
}

void SimulatedWire::destroy(Station& sender) EBAC_RT {
  constexpr int kSent = 8;
  ++destroyed_;
  const bool alone = !acknowledged();
  for (Station& one : station_) {
    if (&one != &sender && !one.off && !alone) {
      one.received_errors = std::min(one.received_errors + 1, kPassive + 1);
    }
    one.was_passive = one.was_passive || one.passive();
  }
  // Nobody else on the bus: the counter stays where it makes the sender passive (12.1.4.2, rule 3).
  if (alone && sender.passive()) return;
  sender.sent_errors += kSent;
  sender.was_passive = sender.was_passive || sender.passive();
  if (sender.sent_errors <= kOff) return;
  sender.off = true;
  sender.queue.clear();
  sender.recovery = std::int64_t{kRecovery} * kRecessive;
}

void SimulatedWire::recover(std::int64_t bits) EBAC_RT {
  for (Station& one : station_) {
    if (!one.off || !one.recovers) continue;
    one.recovery -= bits;
    if (one.recovery > 0) continue;
    one.off = false;
    one.sent_errors = one.received_errors = 0;
  }
}

}  // namespace ebac::can
