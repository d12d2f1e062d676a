#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "ebac/can/frame.hpp"
#include "ebac/canopen/cia402.hpp"
#include "ebac/canopen/cob_id.hpp"
#include "ebac/canopen/nmt.hpp"
#include "ebac/canopen/pdo_plan.hpp"
#include "ebac/core/fields.hpp"

namespace ebac::can {

/// Columns of a trace for one drive on the bus. Counts only grow.
struct BusRow {
  int statusword = 0;
  int controlword = 0;
  int target_permille = 0;     // thousandths of the rated torque
  int actual_permille = 0;     // thousandths of the rated torque
  int emergency = 0;           // error code, CiA 301 and 402
  int heartbeat = -1;          // NMT state
  std::int64_t age = 0;        // samples
  std::int64_t missing = 0;    // ticks
  std::int64_t late = 0;       // frames
  std::int64_t duplicate = 0;  // frames
  std::int64_t malformed = 0;  // frames
  std::int64_t foreign = 0;    // frames
  std::int64_t refused = 0;    // frames

  static constexpr auto fields() {
    using F = Field<BusRow>;
    return std::array{
        F{"statusword", &BusRow::statusword, "1", "last statusword of the drive (0x6041)"},
        F{"controlword", &BusRow::controlword, "1", "controlword sent in this tick (0x6040)"},
        F{"target_permille", &BusRow::target_permille, "1",
          "torque sent in this tick, in thousandths of the rated torque (0x6071)"},
        F{"actual_permille", &BusRow::actual_permille, "1",
          "torque the drive says it gave, in thousandths of the rated torque (0x6077)"},
        F{"emergency", &BusRow::emergency, "1", "error code of the last emergency; 0 for none yet"},
        F{"heartbeat", &BusRow::heartbeat, "1",
          "NMT state in the last heartbeat: 0 boot-up, 4 stopped, 5 operational, 127 "
          "pre-operational; -1 for none yet"},
        F{"age", &BusRow::age, "samples", "age of the drive's process data; 0 when of this tick"},
        F{"missing", &BusRow::missing, "1", "ticks without process data of the drive, so far"},
        F{"late", &BusRow::late, "1", "answers that came after their tick, so far"},
        F{"duplicate", &BusRow::duplicate, "1", "answers to a tick that had one, so far"},
        F{"malformed", &BusRow::malformed, "1", "frames of the drive of a wrong length, so far"},
        F{"foreign", &BusRow::foreign, "1",
          "frames that belong to no drive of this device, so far; one count for the whole bus"},
        F{"refused", &BusRow::refused, "1",
          "frames to the drive, SYNC among them, that the bus did not take, so far"},
    };
  }
};

/// One drive as the loop sees it: commands sent, answers received, and errors in between.
class NodeLink {
 public:
  static constexpr int kOperational = static_cast<int>(NmtState::kOperational);

  /// `zero`: the position that counts as 0.
  explicit NodeLink(NodeId node, std::int32_t zero = 0) EBAC_RT
      : node_(node),
        zero_(static_cast<std::uint32_t>(zero)) {}

  Frame command(DriveCommand command, std::int16_t permille) EBAC_RT {
    const std::uint16_t controlword = word_of(command);
    row_.controlword = controlword;
    row_.target_permille = permille;
    Frame out{.id = rpdo(1, node_), .size = kRpdoSize};
    put(out.data, 0, controlword);
    put(out.data, 2, permille);
    return out;
  }

  /// Whether the bus took the frame. A drive that receives none keeps its last torque.
  void sent(bool taken) EBAC_RT {
    unsent_ = taken ? 0 : unsent_ + 1;
    if (!taken) ++row_.refused;
  }

  /// Reads a data frame with an 11-bit identifier; false if it does not concern this node.
  bool take(const Frame& frame) EBAC_RT {
    if (frame.id == tpdo(1, node_)) {
      take_process_data(frame);
    } else if (frame.id == emcy(node_)) {
      take_emergency(frame);
    } else if (frame.id == heartbeat(node_)) {
      take_heartbeat(frame);
    } else {
      // SDO traffic of another master in parallel to the loop is expected.
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
  /// Frames left of the last tick have been read: from here on, process data answer this one.
  void sync() EBAC_RT {
    answered_ = false;
    synced_ = true;
  }
  /// The time for answers is over.
  void close() EBAC_RT {
    synced_ = false;
    twice_ = std::max(0, twice_ - 1);
    steady_ = answered_ ? std::min(steady_ + 1, kForgotten) : 0;
    if (steady_ == kForgotten) owed_ = 0;
    if (answered_) return;
    owed_ = std::min(owed_ + 1, kMostOwed);
    ++row_.missing;
    ++row_.age;
  }

  /// Forgets alarms and starts to watch the heartbeat anew.
  void start() EBAC_RT {
    alarmed_ = false;
    quiet_ = 0;
    twice_ = 0;
  }

  NodeId node() const EBAC_RT { return node_; }
  int unsent() const EBAC_RT { return unsent_; }  // ticks in a row
  bool answered() const EBAC_RT { return answered_; }
  /// Whether answers come that this drive cannot have sent: more than one a tick, of other contents.
  bool duplicated() const EBAC_RT { return twice_ > 2 * kTwice; }
  bool alarmed() const EBAC_RT { return alarmed_; }  // an emergency stands
  double quiet() const EBAC_RT { return quiet_; }    // s, since the last heartbeat
  bool left() const EBAC_RT { return row_.heartbeat >= 0 && row_.heartbeat != kOperational; }
  std::int64_t counts() const EBAC_RT { return counts_; }    // from the zero
  double counts_age() const EBAC_RT { return counts_age_; }  // s, since their SYNC
  std::int16_t actual_permille() const EBAC_RT {
    return static_cast<std::int16_t>(row_.actual_permille);
  }
  DriveState state() const EBAC_RT { return state_of(static_cast<std::uint16_t>(row_.statusword)); }
  bool off() const EBAC_RT { return power_off(static_cast<std::uint16_t>(row_.statusword)); }
  const BusRow& row() const EBAC_RT { return row_; }
  BusRow& row() EBAC_RT { return row_; }

 private:
  static constexpr int kMostOwed = 1000;   // answers: the most ticks a drive may be silent for
  static constexpr int kForgotten = 1000;  // ticks in a row with an answer: what is owed is lost
  static constexpr int kTwice = 10;        // ticks that a second answer is remembered

  void take_process_data(const Frame& frame) EBAC_RT {
    if (frame.size != kTpdoSize) {
      ++row_.malformed;
      return;
    }
    if (answered_) ++row_.duplicate;
    if (answered_ && frame.data != answer_) count_second();
    answer_ = frame.data;
    if (!answered_ && !synced_ && heard_) ++row_.late;
    answered_ = true;
    row_.age = 0;
    counts_age_ = synced_ ? 0 : elapsed_;
    row_.statusword = get<std::uint16_t>(frame.bytes(), 0);
    unwrap(get<std::uint32_t>(frame.bytes(), 2));
    row_.actual_permille = get<std::int16_t>(frame.bytes(), 6);
  }

  /// A second answer in a tick is one that is owed, from a tick that had none, or another node's.
  void count_second() EBAC_RT {
    if (owed_ > 0) {
      --owed_;
    } else {
      twice_ = std::min(twice_ + kTwice, kForgotten);
    }
  }

  /// 0x6064 wraps after 32 bits; the nearest count to the last one that shows the same is meant. The
  /// first one is nearest to the zero.
  void unwrap(std::uint32_t position) EBAC_RT {
    const std::uint32_t shown = position - zero_;
    const auto step = static_cast<std::int32_t>(shown - static_cast<std::uint32_t>(counts_));
    counts_ = heard_ ? counts_ + step : static_cast<std::int32_t>(shown);
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
  std::uint32_t zero_;  // counts
  bool answered_ = false;
  bool synced_ = false;
  bool heard_ = false;
  bool alarmed_ = false;
  double elapsed_ = 0;     // s, since the last tick
  double quiet_ = 0;       // s
  double counts_age_ = 0;  // s
  int unsent_ = 0;
  int owed_ = 0;    // answers
  int steady_ = 0;  // ticks in a row with an answer
  int twice_ = 0;   // ticks
  std::array<std::uint8_t, 8> answer_{};
  std::int64_t counts_ = 0;
  BusRow row_{};
};

}  // namespace ebac::can
