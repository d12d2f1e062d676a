#pragma once

#include <cmath>
#include <memory>
#include <utility>

#include "ebac/core/concepts.hpp"
#include "ebac/loop/row_parts.hpp"
#include "ebac/rt/aim_cell.hpp"

namespace ebac::rt {

/// A simulated device whose hand is told by a cell where to go, where there is one. Copies share it.
template <Device D>
class Aimed {
 public:
  explicit Aimed(D device, std::shared_ptr<AimCell> cell = nullptr)
      : device_(std::move(device)), cell_(std::move(cell)) {}

  Reading exchange(const Command& command) EBAC_RT {
    // Who only looks, and no time passes, takes nothing away.
    if (cell_ != nullptr && command.elapsed > 0) follow(cell_->take());
    return device_.exchange(command);
  }

  auto parts() const EBAC_RT { return row_parts(device_); }
  const D& device() const EBAC_RT { return device_; }

 private:
  void follow(const Aim* aim) EBAC_RT {
    if (aim == nullptr) return;
    for (std::size_t i = 0; i < kMaxAxes; ++i) {
      if (std::isfinite(aim->target[i])) device_.aim(i, aim->target[i]);
    }
  }

  D device_;
  std::shared_ptr<AimCell> cell_;
};

/// A device of a loop whose hand is simulated elsewhere: where it should go is passed on with the
/// next exchange. Without a cell nobody is told. What else the device can do, it still can.
template <Device D>
class Aiming {
 public:
  explicit Aiming(D device, std::shared_ptr<AimCell> cell = nullptr)
      : device_(std::move(device)), cell_(std::move(cell)) {}

  Reading exchange(const Command& command) EBAC_RT {
    if (new_ && cell_ != nullptr) cell_->post(aim_);
    new_ = false;
    return device_.exchange(command);
  }
  /// A target that is no number leaves the hand of that axis alone.
  void aim(std::size_t axis, double target) EBAC_RT {
    aim_.target[axis] = target;
    new_ = true;
  }

  void enable() EBAC_RT { device_.enable(); }
  void disable() EBAC_RT { device_.disable(); }
  void stop() EBAC_RT { device_.stop(); }
  bool running() const EBAC_RT { return device_.running(); }
  bool at_rest() const EBAC_RT { return device_.at_rest(); }

  D& device() EBAC_RT { return device_; }
  auto parts() const EBAC_RT { return row_parts(device_); }

 private:
  D device_;
  std::shared_ptr<AimCell> cell_;
  Aim aim_;
  bool new_ = false;
};

}  // namespace ebac::rt
