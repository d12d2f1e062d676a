#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "ebac/loop/device_around.hpp"

namespace ebac {

/// A device that gets each command some ticks later than the loop gave it: a transport delay to try a law under. Only for
/// simulated devices: a command to rest comes as late as any other.
template <Device D>
class HeldBackCommands : public DeviceAround<D> {
  using DeviceAround<D>::device_;

 public:
  static constexpr std::size_t kMost = 7;  // ticks

  explicit HeldBackCommands(D device) : DeviceAround<D>(std::move(device)) {}

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

 private:
  static constexpr std::size_t kPlaces = kMost + 1;

  std::array<Command, kPlaces> commands_{};
  std::size_t newest_ = 0;
  std::size_t ticks_ = 0;
};

}  // namespace ebac
