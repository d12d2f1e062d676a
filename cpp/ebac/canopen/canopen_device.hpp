#pragma once

#include <algorithm>
#include <span>
#include <utility>

#include "ebac/can/bus.hpp"
#include "ebac/can/wait.hpp"
#include "ebac/canopen/canopen_setup.hpp"
#include "ebac/canopen/enable_sequence.hpp"
#include "ebac/canopen/node_link.hpp"
#include "ebac/canopen/torque.hpp"
#include "ebac/canopen/torque_watch.hpp"
#include "ebac/core/device.hpp"

namespace ebac::can {

/// CANopen drives as a device of the loop, one per axis: controlword and target torque out, SYNC,
/// then statusword, position and actual torque in. The caller keeps the bus, which must outlive
/// this object.
///
/// Starts at rest: every exchange then commands the drives to stay off. After `enable` each
/// exchange takes them one state further, with zero torque until all are enabled. A fault found
/// here stops the drives in the next exchange and persists until `enable` is called again.
template <Bus B, Wait W>
class CanopenDevice {
 public:
  using State = BusRow;
  static constexpr std::string_view kPrefix = "bus.";
  /// More than a bus can carry in a tick; a flood is read on in the next one.
  static constexpr int kMostFrames = 1024;

  /// Throws std::invalid_argument for a setup that cannot be.
  CanopenDevice(B& bus, W wait, const CanopenSetup& setup)
      : bus_(&bus),
        wait_(std::move(wait)),
        setup_(setup),
        scale_(TorqueScale::of(setup.motor, setup.drive)) {
    check_setup(setup);
  }

  Reading exchange(const Command& command) EBAC_RT {
    wait_.begin(command.elapsed);
    for (NodeLink& link : links()) link.open(command.elapsed);
    drain();
    for (NodeLink& link : links()) link.sync();
    send(command);
    collect();
    beat(command.elapsed);  // before SYNC it would delay it, and with it every reading of this tick
    guard(command.elapsed);
    sequence_.tick();
    for (std::size_t i = 0; NodeLink& link : links()) {
      link.close();
      link.row().foreign = foreign_;
      watch_[i].ask(link.row().target_permille);
      if (link.answered()) watch_[i].answer(link.row().actual_permille);
      ++i;
    }
    supervise();
    return reading();
  }

  void enable() EBAC_RT {
    fault_ = Fault::kNone;
    second_master_ = false;
    sequence_.want(EnableSequence::Goal::kRun);
    for (NodeLink& link : links()) link.start();
    for (TorqueWatch& watch : watch_) watch.start();
  }
  /// Zero torque, then down the states one by one: the end of a good run.
  void disable() EBAC_RT {
    if (sequence_.goal() != EnableSequence::Goal::kRest)
      sequence_.want(EnableSequence::Goal::kRest);
  }
  /// Zero torque, then the shortest way out.
  void stop() EBAC_RT {
    if (sequence_.goal() != EnableSequence::Goal::kStop)
      sequence_.want(EnableSequence::Goal::kStop);
  }

  /// Every drive is enabled and follows its torque.
  bool running() const EBAC_RT { return sequence_.running(); }
  /// Every drive answered in the last tick and reports that its power is off.
  bool at_rest() const EBAC_RT {
    return std::ranges::all_of(links(),
                               [](const NodeLink& link) { return link.answered() && link.off(); });
  }
  Fault fault() const EBAC_RT { return fault_; }
  const State& state(std::size_t axis) const EBAC_RT { return link_[axis].row(); }

 private:
  std::span<NodeLink> links() EBAC_RT {
    return std::span(link_).first(static_cast<std::size_t>(setup_.axes));
  }
  std::span<const NodeLink> links() const EBAC_RT {
    return std::span(link_).first(static_cast<std::size_t>(setup_.axes));
  }

  /// Reads the frames received since the last exchange.
  void drain() EBAC_RT {
    Frame frame;
    for (int i = 0; i < kMostFrames && bus_->receive(frame); ++i) take(frame);
  }

  void send(const Command& command) EBAC_RT {
    for (std::size_t i = 0; NodeLink& link : links()) {
      const double current = setup_.motor_sign[i] * command.current[i];
      const std::int16_t torque = sequence_.running() ? scale_.permille(current) : std::int16_t{0};
      ++i;
      link.sent(bus_->send(link.command(next_for(link), torque)));
    }
    if (!bus_->send({.id = kSync})) {
      for (NodeLink& link : links()) ++link.row().refused;
    }
  }

  /// A drive that falls silent on its way down goes off at once: its state is not known any more.
  DriveCommand next_for(const NodeLink& link) const EBAC_RT {
    const bool lost =
        sequence_.goal() == EnableSequence::Goal::kRest && link.row().age >= setup_.silent_ticks;
    return lost ? DriveCommand::kDisableVoltage : sequence_.command(link.state());
  }

  /// The loop's own heartbeat, for drives that watch it (0x1016).
  void beat(double elapsed) EBAC_RT {
    since_beat_ += elapsed;
    if (setup_.own_node == 0 || since_beat_ < setup_.heartbeat_period) return;
    if (bus_->send(
            frame(heartbeat(static_cast<NodeId>(setup_.own_node)), {NodeLink::kOperational}))) {
      since_beat_ = 0;
      return;
    }
    for (NodeLink& link : links()) ++link.row().refused;  // the next tick tries again
  }

  /// Node guarding, for drives that watch no heartbeat (0x100C).
  void guard(double elapsed) EBAC_RT {
    since_guard_ += elapsed;
    if (setup_.guard_period <= 0 || since_guard_ < setup_.guard_period) return;
    since_guard_ = 0;
    for (NodeLink& link : links()) {
      if (!bus_->send({.id = heartbeat(link.node()), .size = 1, .remote = true}))
        ++link.row().refused;
    }
  }

  void collect() EBAC_RT {
    const auto waiting = [](const NodeLink& link) { return !link.answered(); };
    Frame frame;
    for (int i = 0; i < kMostFrames && std::ranges::any_of(links(), waiting);) {
      if (bus_->receive(frame)) {
        take(frame);
        ++i;
      } else if (!wait_.more()) {
        return;
      }
    }
  }

  void take(const Frame& frame) EBAC_RT {
    if (!frame.extended && !frame.remote && !frame.error) {
      if (frame.id == kNmt) return;
      for (NodeLink& link : links()) {
        if (link.take(frame)) return;
      }
      if (!frame.own && commands(frame)) second_master_ = true;
    }
    ++foreign_;
  }

  /// Whether only this loop may send this frame: SYNC, the torques, its heartbeat.
  bool commands(const Frame& frame) const EBAC_RT {
    if (frame.id == kSync) return true;
    if (setup_.own_node != 0 && frame.id == heartbeat(static_cast<NodeId>(setup_.own_node))) {
      return true;
    }
    return std::ranges::any_of(
        links(), [&](const NodeLink& link) { return frame.id == rpdo(1, link.node()); });
  }

  void supervise() EBAC_RT {
    const auto enabled = [](const NodeLink& link) {
      return link.answered() && link.state() == DriveState::kOperationEnabled;
    };
    if (sequence_.goal() != EnableSequence::Goal::kRun) return;
    if (sequence_.enabling() && std::ranges::all_of(links(), enabled)) {
      for (NodeLink& link : links()) link.start();
      sequence_.run();
    }
    fault_ = down() ? Fault::kBusDown : Fault::kNone;
    if (fault_ == Fault::kNone && second_master_) fault_ = Fault::kSecondMaster;
    for (const NodeLink& link : links()) {
      if (fault_ == Fault::kNone && link.duplicated()) fault_ = Fault::kDuplicateNode;
      if (fault_ == Fault::kNone) fault_ = sequence_.running() ? lost(link) : not_enabled(link);
    }
    for (std::size_t i = 0; i < links().size(); ++i) {
      if (fault_ == Fault::kNone && watch_[i].differs()) fault_ = Fault::kTorqueMismatch;
    }
    if (fault_ != Fault::kNone) stop();
  }

  NodeLink link_to(std::size_t axis) const EBAC_RT {
    return NodeLink(setup_.node[axis], setup_.encoder_zero[axis]);
  }
  TorqueWatch watch() const EBAC_RT { return {setup_.torque_ticks, setup_.torque_tolerance}; }

  bool down() const EBAC_RT { return std::as_const(*bus_).state() >= BusState::kBusOff; }

  /// Why a drive that ran no longer does.
  Fault lost(const NodeLink& link) const EBAC_RT {
    if (link.alarmed()) return Fault::kDriveEmergency;
    if (faulty(link.state())) return Fault::kDriveFault;
    if (link.state() != DriveState::kOperationEnabled) return Fault::kDriveDisabled;
    if (link.row().age >= setup_.silent_ticks) return Fault::kDriveSilent;
    if (link.unsent() >= setup_.silent_ticks) return Fault::kBusDown;
    const bool watched = setup_.heartbeat_timeout > 0;
    const bool dead = watched && (link.left() || link.quiet() > setup_.heartbeat_timeout);
    return dead ? Fault::kHeartbeatLost : Fault::kNone;
  }

  /// Why a drive will not run.
  Fault not_enabled(const NodeLink& link) const EBAC_RT {
    if (faulty(link.state())) return Fault::kDriveFault;
    if (sequence_.ticks() < setup_.enable_ticks) return Fault::kNone;
    if (!link.answered()) return Fault::kDriveSilent;
    return link.state() == DriveState::kOperationEnabled ? Fault::kNone : Fault::kDriveDisabled;
  }

  Reading reading() const EBAC_RT {
    Reading out{.fault = fault_};
    for (std::size_t i = 0; const NodeLink& link : links()) {
      out.counts[i] = setup_.encoder_sign[i] * link.counts();
      out.counts_age[i] = link.counts_age();
      out.current_applied[i] = setup_.motor_sign[i] * scale_.current(link.actual_permille());
      ++i;
    }
    return out;
  }

  B* bus_;
  W wait_;
  CanopenSetup setup_;
  TorqueScale scale_;
  EnableSequence sequence_;
  std::array<NodeLink, kMaxAxes> link_{link_to(0), link_to(1), link_to(2)};
  std::array<TorqueWatch, kMaxAxes> watch_{watch(), watch(), watch()};
  std::int64_t foreign_ = 0;
  bool second_master_ = false;  // heard since the drives were last enabled
  double since_beat_ = 0;       // s
  double since_guard_ = 0;      // s
  Fault fault_ = Fault::kNone;
};

}  // namespace ebac::can
