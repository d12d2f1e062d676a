#pragma once

#include <cstddef>
#include <ebac/core/device.hpp>
#include <ebac/loop/mailbox.hpp>
#include <ebac/model/kinematics.hpp>
#include <memory>
#include <tuple>
#include <utility>

namespace chai {

/// Where a hand wants to be [m], from one thread to the loop.
using Wishes = ebac::Mailbox<ebac::Axes>;

/// A simulated device whose hand is led by another thread, as by the mouse.
template <ebac::Device D>
class LedHand {
 public:
  LedHand(D device, std::shared_ptr<Wishes> wishes)
      : device_(std::move(device)), wishes_(std::move(wishes)) {}

  ebac::Reading exchange(const ebac::Command& command) EBAC_RT {
    if (const ebac::Axes* wish = wishes_->take()) {
      for (std::size_t i = 0; i < ebac::kMaxAxes; ++i)
        device_.aim(i, (*wish)[static_cast<Eigen::Index>(i)]);
    }
    return device_.exchange(command);
  }

  auto parts() const EBAC_RT { return std::tie(device_); }

 private:
  D device_;
  std::shared_ptr<Wishes> wishes_;
};

}  // namespace chai
