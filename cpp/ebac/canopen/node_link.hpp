#pragma once

#include "ebac/can/bus_row.hpp"
#include "ebac/can/cob_id.hpp"
#include "ebac/can/drive_words.hpp"
#include "ebac/can/frame.hpp"
#include "ebac/can/pdo_plan.hpp"

namespace ebac::can {

/// One drive as the loop sees it: what it was told, what it answered, and what went wrong between.
class NodeLink {
 public:
  static constexpr int kOperational = 0x05;  // NMT state in a heartbeat

  explicit NodeLink(NodeId node) EBAC_RT : node_(node) {}

  Frame command(DriveCommand command, std::int16_t permille) EBAC_RT {
    const std::uint16_t controlword = word_of(command);
    row_.controlword = controlword;
    row_.target_permille = permille;
    Frame out{.id = rpdo(1, node_), .size = kRpdoSize};
    put(out.data, 0, controlword);
    put(out.data, 2, permille);
    return out;
  }

  /// Whether the bus took that frame. A drive that is told nothing keeps its last torque.
  void told(bool taken) EBAC_RT {
    untold_ = taken ? 0 : untold_ + 1;
    if (!taken) ++row_.refused;
  }

  /// Reads a data frame with an 11-bit identifier; false for one that is no business of this node.
  bool take(const Frame& frame) EBAC_RT {
    if (frame.id == tpdo(1, node_)) {
      take_process_data(frame);
    } else if (frame.id == emcy(node_)) {
      take_emergency(frame);
    } else if (frame.id == heartbeat(node_)) {
      take_heartbeat(frame);
    } else {
      // Parameters, in parallel to the loop: somebody else's talk, and expected.
      return frame.id == sdo_answer(node_) || frame.id == sdo_request(node_);
    }
    return true;
  }

  /// A tick begins, `elapsed` s after the last one.
  void open(double elapsed) EBAC_RT {
    elapsed_ = elapsed;
    quiet_ += elapsed;
    counts_age_ += elapsed;
  }
  /// What was left of the last tick is read: from here on, process data answer this one.
  void sync() EBAC_RT {
    answered_ = false;
    synced_ = true;
  }
  /// The time for answers is over.
  void close() EBAC_RT {
    synced_ = false;
    if (answered_) return;
    ++row_.missing;
    ++row_.age;
  }

  /// Forgets alarms and starts to watch the heartbeat anew.
  void start() EBAC_RT {
    alarmed_ = false;
    quiet_ = 0;
  }

  int untold() const EBAC_RT { return untold_; }  // ticks in a row
  bool answered() const EBAC_RT { return answered_; }
  bool heard() const EBAC_RT { return heard_; }      // process data, ever
  bool alarmed() const EBAC_RT { return alarmed_; }  // an emergency stands
  double quiet() const EBAC_RT { return quiet_; }    // s, since the last heartbeat
  bool left() const EBAC_RT { return row_.heartbeat >= 0 && row_.heartbeat != kOperational; }
  std::int64_t counts() const EBAC_RT { return counts_; }
  double counts_age() const EBAC_RT { return counts_age_; }  // s, since their SYNC
  std::int16_t actual_permille() const EBAC_RT {
    return static_cast<std::int16_t>(row_.actual_permille);
  }
  DriveState state() const EBAC_RT { return state_of(static_cast<std::uint16_t>(row_.statusword)); }
  const BusRow& row() const EBAC_RT { return row_; }
  BusRow& row() EBAC_RT { return row_; }

 private:
  void take_process_data(const Frame& frame) EBAC_RT {
    if (frame.size != kTpdoSize) {
      ++row_.malformed;
      return;
    }
    if (answered_) ++row_.duplicate;
    if (!answered_ && !synced_ && heard_) ++row_.late;
    answered_ = true;
    row_.age = 0;
    counts_age_ = synced_ ? 0 : elapsed_;
    row_.statusword = get<std::uint16_t>(frame.bytes(), 0);
    unwrap(get<std::uint32_t>(frame.bytes(), 2));
    row_.actual_permille = get<std::int16_t>(frame.bytes(), 6);
  }

  /// 0x6064 wraps after 32 bits; the nearest count to the last one that shows the same is meant.
  void unwrap(std::uint32_t position) EBAC_RT {
    const auto step = static_cast<std::int32_t>(position - static_cast<std::uint32_t>(counts_));
    counts_ = heard_ ? counts_ + step : static_cast<std::int32_t>(position);
    heard_ = true;
  }

  void take_emergency(const Frame& frame) EBAC_RT {
    if (frame.size != 8) {
      ++row_.malformed;
      return;
    }
    const auto code = get<std::uint16_t>(frame.bytes(), 0);
    alarmed_ = code != 0;  // 0: the error is gone (CiA 301, 7.2.7)
    if (alarmed_) row_.emergency = code;
  }

  void take_heartbeat(const Frame& frame) EBAC_RT {
    if (frame.size != 1) {
      ++row_.malformed;
      return;
    }
    row_.heartbeat = frame.data[0] & 0x7F;
    quiet_ = 0;
  }

  NodeId node_;
  bool answered_ = false;
  bool synced_ = false;
  bool heard_ = false;
  bool alarmed_ = false;
  double elapsed_ = 0;     // s, since the last tick
  double quiet_ = 0;       // s
  double counts_age_ = 0;  // s
  int untold_ = 0;
  std::int64_t counts_ = 0;
  BusRow row_{};
};

}  // namespace ebac::can
