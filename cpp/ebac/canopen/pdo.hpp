#pragma once

#include "ebac/canopen/nmt.hpp"
#include "ebac/canopen/object_dictionary.hpp"

/// The two ends of a PDO in a node (CiA 301, 7.2.2).
namespace ebac::can {

enum class Direction : std::uint8_t { kReceive, kTransmit };

inline constexpr std::uint16_t kDummy = 0xFFFF;  // bytes received and dropped, or sent as 0

/// Mapping of one PDO, ready for use.
struct PdoMap {
  std::array<std::uint16_t, kMapped> slot{};  // or kDummy
  std::array<std::uint8_t, kMapped> size{};   // bytes
  std::uint8_t count = 0;                     // entries
  std::uint8_t bytes = 0;
};

/// Whether `index` belongs to a PDO: 0x1400, 0x1600, 0x1800, 0x1A00 and what follows.
constexpr bool is_pdo(std::uint16_t index) EBAC_RT { return index >= 0x1400 && index < 0x1C00; }

/// Checks a write of `value` to a PDO parameter (CiA 301, 7.5.2.33 to 38): the mapping of a valid
/// PDO, and the entries of a mapping whose sub-index 0 is not 0, are locked.
Abort check_pdo(const ObjectDictionary& objects, const Entry& entry, std::int64_t value) EBAC_RT;

/// Identifiers that no PDO and no EMCY may take (CiA 301, table 41).
bool is_restricted(std::uint32_t id) EBAC_RT;

/// The mapping of PDO `number` (0 to 3), which `check_pdo` let through.
PdoMap read_map(const ObjectDictionary& objects, Direction direction, std::size_t number) EBAC_RT;

inline constexpr std::uint8_t kLastSynchronous = 240;

/// Settings common to both directions.
struct PdoSettings {
  bool valid = false;
  std::uint32_t id = 0;
  std::uint8_t type = 255;  // 0 to 240 synchronous, 254 and 255 event-driven
  PdoMap map{};

  bool synchronous() const EBAC_RT { return type <= kLastSynchronous; }
  bool in_use() const EBAC_RT { return valid && map.count > 0; }
};

inline PdoSettings read_settings(const ObjectDictionary& objects, Direction direction,
                                 std::size_t number) EBAC_RT {
  const std::size_t base = direction == Direction::kReceive ? 0x1400 : 0x1800;
  const auto index = static_cast<std::uint16_t>(base + number);
  const std::int64_t cob_id = objects[kDriveTable.slot(index, 1)];
  return {.valid = (cob_id & kInvalid) == 0,
          .id = static_cast<std::uint32_t>(cob_id & 0x7FF),
          .type = static_cast<std::uint8_t>(objects[kDriveTable.slot(index, 2)]),
          .map = read_map(objects, direction, number)};
}

/// Takes frames in. Synchronous data wait for the next SYNC; of several the last counts.
struct Rpdo {
  PdoSettings settings;
  Watchdog deadline;  // sub-index 5: the longest silence
  Frame waiting;
  bool is_waiting = false;

  void configure(const ObjectDictionary& objects, std::size_t number) EBAC_RT {
    settings = read_settings(objects, Direction::kReceive, number);
    const auto index = static_cast<std::uint16_t>(0x1400 + number);
    deadline.set(objects[kDriveTable.slot(index, 5)] * kMillisecond);
    is_waiting = false;
  }
  bool takes(const Frame& frame) const EBAC_RT {
    return settings.in_use() && frame.id == settings.id;
  }
};

/// Sends frames out.
class Tpdo {
 public:
  void configure(const ObjectDictionary& objects, std::size_t number, std::int64_t now) EBAC_RT {
    settings_ = read_settings(objects, Direction::kTransmit, number);
    const auto index = static_cast<std::uint16_t>(0x1800 + number);
    inhibit_ = objects[kDriveTable.slot(index, 3)] * 100 * kMicrosecond;
    period_ = objects[kDriveTable.slot(index, 5)] * kMillisecond;
    start(now);
  }
  /// The node has become operational, or the PDO valid: its first value is news.
  void start(std::int64_t now) EBAC_RT {
    timer_.start(now, period_);
    free_at_ = now;
    syncs_ = 0;
    due_ = true;
  }

  /// True if this SYNC triggers a frame, which is then in `frame`.
  bool on_sync(const ObjectDictionary& objects, std::int64_t now, Frame& frame) EBAC_RT {
    if (!settings_.in_use() || !settings_.synchronous()) return false;
    pack(objects, frame);
    if (settings_.type == 0) {
      if (!due_ && frame == last_) return false;
    } else if (++syncs_ < settings_.type) {
      return false;
    }
    syncs_ = 0;
    sent(frame, now);
    return true;
  }

  /// True where its data changed, or its event timer ran out, and the inhibit time is over.
  bool on_event(const ObjectDictionary& objects, std::int64_t now, Frame& frame) EBAC_RT {
    if (!settings_.in_use() || settings_.synchronous()) return false;
    if (timer_.due(now)) due_ = true;
    if (now < free_at_) return false;
    pack(objects, frame);
    if (!due_ && frame == last_) return false;
    sent(frame, now);
    return true;
  }

 private:
  void pack(const ObjectDictionary& objects, Frame& frame) const EBAC_RT {
    frame = Frame{.id = settings_.id, .size = settings_.map.bytes};
    std::size_t at = 0;
    for (std::size_t i = 0; i < settings_.map.count; ++i) {
      const auto bytes = std::span(frame.data).subspan(at, settings_.map.size[i]);
      if (settings_.map.slot[i] != kDummy) objects.read(settings_.map.slot[i], bytes);
      at += settings_.map.size[i];
    }
  }
  void sent(const Frame& frame, std::int64_t now) EBAC_RT {
    last_ = frame;
    due_ = false;
    free_at_ = now + inhibit_;
    timer_.start(now, period_);
  }

  PdoSettings settings_;
  std::int64_t inhibit_ = 0;  // ns
  std::int64_t period_ = 0;   // ns, 0 none
  std::int64_t free_at_ = 0;  // ns, when the inhibit time is over
  Timer timer_;
  std::uint8_t syncs_ = 0;
  bool due_ = true;
  Frame last_;
};

}  // namespace ebac::can
