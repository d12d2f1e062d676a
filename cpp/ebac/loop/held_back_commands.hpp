#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "ebac/core/concepts.hpp"
#include "ebac/loop/row_parts.hpp"

namespace ebac {

/// A device that gets each command some ticks later than the loop gave it: a transport delay to try a law under. Only for
/// simulated devices: a command to rest comes as late as any other. Forwards all other calls to the device.
template <Device D>
class HeldBackCommands {
 public:
  static constexpr std::size_t kMost = 7;  // ticks

  explicit HeldBackCommands(D device) : device_(std::move(device)) {}

  Reading exchange(const Command& command) EBAC_RT {
    newest_ = (newest_ + 1) % kPlaces;
    commands_[newest_] = command;
    Command late = commands_[(newest_ + kPlaces - ticks_) % kPlaces];
    late.elapsed = command.elapsed;
    return device_.exchange(late);
  }
  /// From the next exchange on: where the delay grows the last commands are given again, where it shrinks some are left
  /// out.
  void hold_back(std::size_t ticks) EBAC_RT { ticks_ = std::min(ticks, kMost); }

  void aim(std::size_t axis, double target) EBAC_RT
    requires requires(D& d) { d.aim(axis, target); }
  {
    device_.aim(axis, target);
  }
  void enable() EBAC_RT
    requires requires(D& d) {
      { d.enable() } noexcept;
    }
  {
    device_.enable();
  }
  void disable() EBAC_RT
    requires requires(D& d) {
      { d.disable() } noexcept;
    }
  {
    device_.disable();
  }
  void stop() EBAC_RT
    requires requires(D& d) { d.stop(); }
  {
    device_.stop();
  }
  bool running() const EBAC_RT
    requires requires(const D& d) { d.running(); }
  {
    return device_.running();
  }
  bool at_rest() const EBAC_RT
    requires requires(const D& d) { d.at_rest(); }
  {
    return device_.at_rest();
  }

  D& device() EBAC_RT { return device_; }
  auto parts() const EBAC_RT { return row_parts(device_); }

 private:
  static constexpr std::size_t kPlaces = kMost + 1;

  D device_;
  std::array<Command, kPlaces> commands_{};
  std::size_t newest_ = 0;
  std::size_t ticks_ = 0;
};

}  // namespace ebac
