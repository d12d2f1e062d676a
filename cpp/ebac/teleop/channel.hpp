#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "ebac/core/check.hpp"
#include "ebac/core/fields.hpp"
#include "ebac/model/noise.hpp"

namespace ebac::teleop {

/// One direction of a network.
struct Link {
  double delay = 0.05;    // s
  double jitter = 0;      // s
  double loss = 0;        // 1
  double reorder = 0;     // 1
  double corrupt = 0;     // 1
  double cut_every = 0;   // s
  double cut_length = 0;  // s

  static constexpr auto fields() {
    using F = Field<Link>;
    return std::array{
        F{"delay", &Link::delay, "s", "least time a packet takes, one way", 0, 0.5},
        F{"jitter", &Link::jitter, "s", "largest time it takes longer; uniform", 0, 0.2},
        F{"loss", &Link::loss, "1", "share of packets that never arrive", 0, 1},
        F{"reorder", &Link::reorder, "1",
          "share of packets that are held back by 5 ms more, so that later ones overtake them", 0,
          1},
        F{"corrupt", &Link::corrupt, "1",
          "share of datagrams with a flipped bit; in the process `network` only, a simulation "
          "drops "
          "them as the CRC would",
          0, 1},
        F{"cut_every", &Link::cut_every, "s", "period of the cuts of the link; 0 for none", 0, 1e6},
        F{"cut_length", &Link::cut_length, "s", "how long each lasts, at the end of its period", 0,
          1e6},
    };
  }
};

/// Returns the link; throws std::invalid_argument for a field out of its range, and for cuts that never end or never begin.
inline const Link& checked_link(const Link& link) {
  check(link, "Link");
  if (link.cut_every > 0 && !(link.cut_length > 0 && link.cut_length < link.cut_every)) {
    throw std::invalid_argument(
        "Link.cut_length = " + shortest(link.cut_length) +
        " s: must lie above 0 s and below cut_every = " + shortest(link.cut_every) + " s");
  }
  if (link.cut_length > 0 && !(link.cut_every > 0)) {
    throw std::invalid_argument("Link.cut_length = " + shortest(link.cut_length) +
                                " s: needs cut_every, a longer time from one cut to the next");
  }
  return link;
}

/// Delays, drops and reorders what is sent through it, the same way for the same seed. Time goes in
/// ticks of `tick` [s]; its memory is bounded.
template <class Item>
class Channel {
 public:
  Channel(const Link& link, double tick, std::uint64_t seed, std::uint64_t stream)
      : link_(checked_link(link)),
        tick_(tick),
        chance_(seed, stream),
        due_(ticks(link.delay + link.jitter + kHeld) + 1) {}

  /// False where it is lost.
  bool send(const Item& item) {
    // Always as many draws, so that one packet's fate does not depend on another setting.
    const double late = 0.5 * (1 + chance_.symmetric());
    const bool lost = drawn(link_.loss);
    const bool held = drawn(link_.reorder);
    hit_ = drawn(link_.corrupt);
    if (lost || cut()) return false;
    const double seconds = link_.delay + link_.jitter * late + (held ? kHeld : 0.0);
    auto& place = due_[(now_ + ticks(seconds)) % due_.size()];
    if (place.size() >= kMost) return false;
    place.push_back(item);
    newest_ = &place.back();
    return true;
  }
  /// Whether the last item is to be damaged, and the item on its way.
  bool hit() const { return hit_; }
  Item& newest() { return *newest_; }
  /// Calls `take(item)` for what arrives in this tick, then goes on to the next.
  template <class Take>
  void deliver(Take take) {
    auto& place = due_[now_ % due_.size()];
    for (const Item& item : place) take(item);
    place.clear();
    ++now_;
  }
  /// Whether the link is cut now.
  bool cut() const {
    if (!(link_.cut_every > 0)) return false;
    const double into = std::fmod(static_cast<double>(now_) * tick_, link_.cut_every);
    return into >= link_.cut_every - link_.cut_length;
  }

 private:
  static constexpr double kHeld = 5e-3;     // s
  static constexpr std::size_t kMost = 64;  // in one tick

  std::size_t ticks(double seconds) const {
    return static_cast<std::size_t>(std::llround(seconds / tick_));
  }
  bool drawn(double share) { return 0.5 * (1 + chance_.symmetric()) < share; }

  Link link_;
  double tick_;  // s
  Noise chance_;
  std::vector<std::vector<Item>> due_;  // by tick, up to the longest delay
  std::size_t now_ = 0;
  bool hit_ = false;
  Item* newest_ = nullptr;
};

}  // namespace ebac::teleop
