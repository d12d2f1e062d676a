#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/teleop/coupling.hpp"
#include "ebac/teleop/packet.hpp"

namespace ebac::teleop {

/// What a receiver has met since it was made.
struct Arrivals {
  std::int64_t received = 0;
  std::int64_t missing = 0;
  std::int64_t late = 0;
  std::int64_t doubled = 0;
  std::int64_t foreign = 0;

  static constexpr auto fields() {
    using F = Field<Arrivals>;
    return std::array{
        F{"received", &Arrivals::received, "1", "packets of the session"},
        F{"missing", &Arrivals::missing, "1",
          "sequence numbers after the first that have not come, so far"},
        F{"late", &Arrivals::late, "1", "packets overtaken by a later one"},
        F{"doubled", &Arrivals::doubled, "1", "packets that had come before"},
        F{"foreign", &Arrivals::foreign, "1",
          "packets of an earlier session, or far from all others of this one: not used"},
    };
  }
};

/// Puts packets in order. Without a buffer the newest one counts and older ones are ignored. With a
/// buffer of `ticks`, the play-out runs that far behind the newest, one packet a tick, and takes the place of a
/// lost packet from its neighbours: along a straight line, so that the energy of a lost wave is never more than
/// what was sent (Jensen).
class Receiver {
 public:
  explicit Receiver(int ticks = 0) EBAC_RT : buffer_(ticks) {}

  void reset() EBAC_RT {
    for (Packet& packet : ring_) packet.sequence = 0;
    newest_ = 0;
    sure_ = false;
    play_ = 0;
  }

  void take(const Packet& packet) EBAC_RT {
    if (packet.sequence == 0) return;
    if (ring_[packet.sequence % kRing].sequence == packet.sequence) {
      ++arrivals_.doubled;
      return;
    }
    if (is_far(packet)) {
      if (!sure_) {
        forget_first();
      } else if (is_news(packet)) {
        return refuse();
      } else {
        return;  // its place is another's
      }
    }
    sure_ = newest_ > 0;
    ++arrivals_.received;
    if (packet.sequence > newest_) {
      if (newest_ == 0)
        first_ = packet.sequence;
      else
        arrivals_.missing += packet.sequence - newest_ - 1;
      newest_ = packet.sequence;
    } else {
      ++arrivals_.late;
      if (packet.sequence > first_) --arrivals_.missing;
    }
    ring_[packet.sequence % kRing] = packet;
  }
  void refuse() EBAC_RT { ++arrivals_.foreign; }
  /// Whether it is newer than all before: a repeated packet is no sign of life.
  bool is_news(const Packet& packet) const EBAC_RT { return packet.sequence > newest_; }

  /// In every tick: what counts now; all zero before the first packet.
  Packet play() EBAC_RT {
    if (newest_ == 0) return {};
    const auto newest = static_cast<double>(newest_);
    const double goal = newest - buffer_;
    if (buffer_ == 0) {
      play_ = newest;
    } else if (play_ == 0 || std::abs(goal - play_) > kFar) {
      play_ = std::max(goal, play_);
    } else {
      // The two clocks run apart by some millionths: follow slowly.
      play_ = std::min(newest, play_ + std::max(0.0, 1 + kFollow * (goal - play_)));
    }
    return at(play_);
  }

  /// The newest number, once two packets have had one near it.
  std::uint32_t newest() const EBAC_RT { return sure_ ? newest_ : 0; }
  const Arrivals& arrivals() const EBAC_RT { return arrivals_; }

 private:
  static constexpr std::uint32_t kJump =
      60'000;  // packets: a minute; more within a session is none of its own
  static constexpr double kFollow = 0.002;  // of the distance, in each tick
  static constexpr double kFar = 200;       // packets

  bool is_far(const Packet& packet) const EBAC_RT {
    if (newest_ == 0) return false;
    return is_news(packet) ? packet.sequence - newest_ > kJump : packet.sequence + kRing <= newest_;
  }
  /// The first packet of a session may have any number, as the other side may long have been sending.
  /// Where the second is far from it, the first was none of this session.
  void forget_first() EBAC_RT {
    --arrivals_.received;
    refuse();
    reset();
  }

  bool has(std::uint32_t sequence) const EBAC_RT {
    return ring_[sequence % kRing].sequence == sequence;
  }

  Packet at(double play) const EBAC_RT {
    if (play < 1) return {};
    auto low = static_cast<std::uint32_t>(play);
    std::uint32_t high = low + (play > low ? 1 : 0);
    const std::uint32_t oldest = newest_ > kRing - 1 ? newest_ - (kRing - 1) : 1;
    while (low >= oldest && !has(low)) --low;
    while (high < newest_ && !has(high)) ++high;
    if (low < oldest) return {};
    Packet packet = ring_[low % kRing];
    if (high <= low || !has(high)) return packet;
    const Packet& next = ring_[high % kRing];
    const double share = (play - low) / static_cast<double>(high - low);
    packet.value += share * (next.value - packet.value);
    packet.energy += share * (next.energy - packet.energy);
    packet.wave += share * (next.wave - packet.wave);
    for (std::size_t i = 0; i < packet.more.size(); ++i) {
      packet.more[i] += share * (next.more[i] - packet.more[i]);
    }
    return packet;
  }

  double buffer_;  // packets
  std::array<Packet, kRing> ring_{};
  std::uint32_t first_ = 0;  // number of the first packet
  std::uint32_t newest_ = 0;
  bool sure_ = false;  // that it is one of this session: a second number was near it
  double play_ = 0;
  Arrivals arrivals_{};
};

}  // namespace ebac::teleop
