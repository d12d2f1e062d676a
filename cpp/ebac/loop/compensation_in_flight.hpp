#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "ebac/control/commands_in_flight.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/model/kinematics.hpp"

namespace ebac {

/// Static compensation on its way to the motors: what of it is in the torque that acts. It has the gain with which its
/// command was sent, that of a soft start or stop; a command that a limit cuts counts as one of the law that was cut.
class CompensationInFlight {
 public:
  /// `delay`: ticks from computing a command to its acting.
  explicit CompensationInFlight(int delay) EBAC_RT : gain_(delay + 1) {
    motion_.fill(CommandsInFlight(delay + 1));
  }

  /// Compensation of friction and inertia within the command of this tick [N m].
  void give(const Axes& motion) EBAC_RT {
    given_ = motion;
    gain_of_given_ = 1;
  }

  /// Another gain with which it was sent; 0 where it was not.
  void sent_with(double gain) EBAC_RT { gain_of_given_ = std::min(gain_of_given_, gain); }

  /// The next tick: what acted over the interval that ended with it.
  void advance() EBAC_RT {
    for (std::size_t i = 0; i < kMaxAxes; ++i) {
      const double torque = given_[static_cast<Eigen::Index>(i)];
      motion_[i].push(gain_of_given_ > 0 ? gain_of_given_ * torque : 0.0);
    }
    gain_.push(gain_of_given_);
    gain_of_given_ = 0;
  }

  /// Compensation of friction and inertia that acted [N m].
  Axes motion() const EBAC_RT {
    Axes torque;
    for (std::size_t i = 0; i < kMaxAxes; ++i) {
      torque[static_cast<Eigen::Index>(i)] = motion_[i][0];
    }
    return torque;
  }
  /// Gain of what carried weight. The weight itself counts where the device is: only so its work comes back.
  double gain() const EBAC_RT { return gain_[0]; }

 private:
  Axes given_ = Axes::Zero();
  double gain_of_given_ = 0;  // nothing is given yet
  CommandsInFlight gain_;
  std::array<CommandsInFlight, kMaxAxes> motion_{CommandsInFlight(0), CommandsInFlight(0),
                                                 CommandsInFlight(0)};
};

}  // namespace ebac
