#include "ebac/simulated_drives/simulated_drive.hpp"

namespace ebac::can {

SimulatedDrive::SimulatedDrive(const DriveSettings& settings) : objects_(settings.node) {
  const Motor& motor = settings.motor;
  const auto whole = [](double value, double most) {
    return static_cast<std::int64_t>(std::llround(std::clamp(value, 1.0, most)));
  };
  const double peak = settings.drive.peak_current(motor);       // A
  const double one = motor.current(motor.rated_torque) / 1000;  // A per permille
  const std::array<std::int64_t, 4> data{
      whole(motor.torque_constant * 1e5, 1e9), whole(motor.torque(peak) * 1e5, 1e9),
      whole(motor.rated_torque * 1e5, 1e9), settings.counts_per_turn};
  for (std::size_t i = 0; i < data.size(); ++i) {
    objects_.set_default(kAt<0x2383, 12> + i, data[i]);
    objects_.set_default(kAt<0x6410, 12> + i, data[i]);
  }
  objects_.set_default(kAt<0x2112>, whole(settings.peak_time * 1e3, 65535));
  objects_.set_default(kAt<0x6072>, whole(peak / one, 65535));
  objects_.set_default(kAt<0x6073>, whole(peak / one, 65535));
  start_as(settings.sheet);
  boot(0xFFFF);
}

/// Takes the dictionary of a data sheet, and those of its defaults that this drive can have: not
/// those of its PDOs, nor modes it does not offer.
void SimulatedDrive::start_as(std::span<const SheetEntry> sheet) {
  objects_.describe(sheet);
  for (const SheetEntry& given : sheet) {
    const std::size_t slot = kDriveTable.slot(given.index, given.sub);
    if (slot == kNoSlot || !given.has_initial || is_pdo(given.index)) continue;
    const Entry& entry = kDriveTable.entry[slot];
    const bool own = given.index == 0x6502 || given.index == 0x1003;
    if (own || entry.type == Type::kString) continue;
    const bool fits = ObjectDictionary::check_limits(entry, given.initial) == Abort::kNone &&
                      check(slot, given.initial) == Abort::kNone;
    const bool group = entry.sub == 0 && kDriveTable.slot(entry.index, 1) != kNoSlot;
    if (fits && !group) objects_.set_default(slot, given.initial);
  }
}

void SimulatedDrive::send(const Frame& frame) EBAC_RT {
  if (!silent_) out_.push(frame);
}

/// Power-on (`last_index` 0xFFFF) or a new start of the communication alone (0x1FFF).
void SimulatedDrive::boot(std::uint16_t last_index) EBAC_RT {
  if (lss_.pending() != 0) objects_.set_node(lss_.pending());
  lss_.reset();
  objects_.restore(0x1000, last_index);
  sdo_.reset();
  life_.sleep();
  guard_toggle_ = 0;
  synced_at_ = kNever;
  emcy_.clear();
  if (last_index == 0xFFFF) {
    errors_.clear();
    state_ = DriveState::kNotReady;
    last_word_ = 0;
    stage_.off();
    // Status and command objects are not settings, though they may have been stored.
    for (const std::size_t slot :
         {kAt<0x603F>, kAt<0x2183>, kAt<0x6040>, kAt<0x6071>, kAt<0x60B2>}) {
      objects_[slot] = 0;
    }
  }
  objects_[kAt<0x1003>] = 0;
  configure_all();
  set_position(counts_);
  nmt_ = NmtState::kPreOperational;
  send(frame(heartbeat(node()), {0}));
  refresh();
}

bool SimulatedDrive::is_sync(const Frame& frame) const EBAC_RT {
  return !silent_ && !frame.remote && !frame.error && !frame.extended &&
         frame.id == (objects_.get<0x1005>() & 0x7FF);
}

void SimulatedDrive::receive(const Frame& frame) EBAC_RT {
  if (silent_ || frame.error || frame.extended || frame.size > Frame::kMaxSize) return;
  if (frame.remote) {
    if (frame.id == heartbeat(node())) guard();
    return;
  }
  if (frame.id == kNmt) {
    if (frame.size >= 2 && (frame.data[1] == 0 || frame.data[1] == node())) {
      command_node(frame.data[0]);
    }
  } else if (is_sync(frame)) {
    if (nmt_ == NmtState::kOperational) synchronise(frame);
  } else if (frame.id == kLssMaster) {
    set_layer(frame);
  } else if (frame.id == sdo_request(node()) && nmt_ != NmtState::kStopped) {
    Frame reply{.id = sdo_answer(node())};
    if (sdo_.answer(frame.bytes(), *this, reply)) send(reply);
    while (sdo_.segment(reply)) send(reply);
  } else if (frame.id > heartbeat(0) && frame.id <= heartbeat(kLastNode)) {
    hear_heartbeat(frame);
  } else if (nmt_ == NmtState::kOperational) {
    receive_pdo(frame);
  }
  refresh();
  send_events();
}

void SimulatedDrive::command_node(std::uint8_t command) EBAC_RT {
  switch (static_cast<NmtCommand>(command)) {
    case NmtCommand::kStart:
      return enter(NmtState::kOperational);
    case NmtCommand::kStop:
      return enter(NmtState::kStopped);
    case NmtCommand::kPreOperational:
      return enter(NmtState::kPreOperational);
    case NmtCommand::kResetNode:
      return boot(0xFFFF);
    case NmtCommand::kResetCommunication:
      if (motor_on()) lose_connection(Cause::kConnection);
      return boot(0x1FFF);
  }
}

void SimulatedDrive::enter(NmtState next) EBAC_RT {
  if (next == nmt_) return;
  if (nmt_ == NmtState::kOperational && motor_on()) lose_connection(Cause::kConnection);
  change(next);
}

void SimulatedDrive::change(NmtState next) EBAC_RT {
  nmt_ = next;
  if (next == NmtState::kStopped) sdo_.reset();
  for (Rpdo& rpdo : rpdo_) {
    rpdo.is_waiting = false;
    rpdo.deadline.sleep();
  }
  sync_watch_.sleep();
  if (next == NmtState::kOperational) {
    for (Tpdo& tpdo : tpdo_) tpdo.start(now_);
  }
}

/// Node guarding (CiA 301, 7.2.8.2.2.1): answers the master, and watches it from then on. A node
/// with a heartbeat is not guarded.
void SimulatedDrive::guard() EBAC_RT {
  if (objects_.get<0x1017>() != 0) return;
  send(frame(heartbeat(node()),
             {static_cast<std::uint8_t>(static_cast<unsigned>(nmt_) | guard_toggle_)}));
  guard_toggle_ ^= 0x80U;
  life_.feed(now_);
  cure(Cause::kHeartbeatLost);
}

void SimulatedDrive::set_layer(const Frame& frame) EBAC_RT {
  LssSlave::Identity own{};
  for (std::size_t i = 0; i < own.size(); ++i) {
    own[i] = static_cast<std::uint32_t>(objects_[kAt<0x1018, 1> + i]);
  }
  Frame reply;
  if (lss_.answer(frame, own, node(), reply)) send(reply);
}

/// First sends the inputs as they are at this SYNC; then applies the data received before it.
void SimulatedDrive::synchronise(const Frame& sync) EBAC_RT {
  const std::size_t counter = objects_.get<0x1019>() == 0 ? 0 : 1;
  if (sync.size != counter) {
    raise(Cause::kSyncLength);
    errors_.gone(Cause::kSyncLength);
    return;
  }
  cure(Cause::kSyncLength);
  synced_at_ = now_;
  sync_watch_.feed(now_);
  cure(Cause::kSyncLost);
  Frame frame;
  for (Tpdo& tpdo : tpdo_) {
    if (tpdo.on_sync(objects_, now_, frame)) send(frame);
  }
  for (Rpdo& rpdo : rpdo_) {
    if (rpdo.is_waiting) apply(rpdo, rpdo.waiting);
    rpdo.is_waiting = false;
  }
}

void SimulatedDrive::receive_pdo(const Frame& frame) EBAC_RT {
  for (Rpdo& rpdo : rpdo_) {
    if (!rpdo.takes(frame)) continue;
    if (frame.size < rpdo.settings.map.bytes) {
      raise(Cause::kRpdoShort);
      errors_.gone(Cause::kRpdoShort);  // no reset waits for a better one
      continue;
    }
    cure(Cause::kRpdoShort);
    cure(Cause::kRpdoLate);
    rpdo.deadline.feed(now_);
    if (rpdo.settings.synchronous()) {
      const std::int64_t window = objects_.get<0x1007>() * kMicrosecond;
      if (window > 0 && synced_at_ != kNever && now_ - synced_at_ > window) continue;
      rpdo.waiting = frame;
      rpdo.is_waiting = true;
    } else {
      apply(rpdo, frame);
    }
  }
}

/// Writes the values of a PDO. If an object refuses a value, it keeps the old one.
void SimulatedDrive::apply(const Rpdo& rpdo, const Frame& frame) EBAC_RT {
  const PdoMap& map = rpdo.settings.map;
  std::size_t at = 0;
  for (std::size_t i = 0; i < map.count; ++i) {
    const auto bytes = frame.bytes().subspan(at, map.size[i]);
    at += map.size[i];
    if (map.slot[i] == kDummy) continue;
    set(map.slot[i], ObjectDictionary::number(kDriveTable.entry[map.slot[i]], bytes));
  }
}

void SimulatedDrive::hear_heartbeat(const Frame& frame) EBAC_RT {
  const auto from = frame.id - heartbeat(0);
  for (std::size_t i = 0; i < kProducers; ++i) {
    const std::int64_t entry = objects_[kAt<0x1016, 1> + i];
    if ((entry >> 16 & 0x7F) != from || (entry & 0xFFFF) == 0) continue;
    producer_[i].feed(now_);
    cure(Cause::kHeartbeatLost);
  }
}

void SimulatedDrive::elapse(std::int64_t ns) EBAC_RT {
  if (ns > 0) {
    now_ += ns;
    const bool held = stage_.holding();
    stage_.elapse(static_cast<double>(ns) / 1e9);
    if (stage_.holding() && !held) overload();
  }
  watch();
  step_by_itself();
  if (heartbeat_.due(now_)) {
    send(frame(heartbeat(node()), {static_cast<std::uint8_t>(nmt_)}));
  }
  send_emcy();
  refresh();
  send_events();
}

void SimulatedDrive::watch() EBAC_RT {
  for (Watchdog& producer : producer_) {
    if (producer.cries(now_)) lose_connection(Cause::kHeartbeatLost);
  }
  if (life_.cries(now_)) lose_connection(Cause::kHeartbeatLost);
  if (nmt_ != NmtState::kOperational) return;
  for (Rpdo& rpdo : rpdo_) {
    if (rpdo.deadline.cries(now_)) lose_connection(Cause::kRpdoLate);
  }
  if (sync_watch_.cries(now_)) lose_connection(Cause::kSyncLost);
}

void SimulatedDrive::send_events() EBAC_RT {
  if (nmt_ != NmtState::kOperational) return;
  Frame frame;
  for (Tpdo& tpdo : tpdo_) {
    if (tpdo.on_event(objects_, now_, frame)) send(frame);
  }
}

}  // namespace ebac::can
