#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "ebac/control/commands_in_flight.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/model/kinematics.hpp"

namespace ebac {

/// Static compensation on its way to the motors: how much of the torque that acts is compensation, and not the law's.
class CompensationInFlight {
 public:
  /// `delay`: ticks from computing a command to its acting.
  explicit CompensationInFlight(int delay) EBAC_RT
      : in_flight_{CommandsInFlight(delay + 1), CommandsInFlight(delay + 1),
                   CommandsInFlight(delay + 1)} {
    static_assert(kMaxAxes == 3);
  }

  /// Compensation within the command of this tick [N m].
  void give(const Axes& torque) EBAC_RT { given_ = torque; }

  /// The tick after it: of that command `sent` was sent, of `asked` [N m], as where the force comes in softly or a limit
  /// cut it; compensation has the same share. Returns the compensation within the torque of the last interval [N m].
  double advance(std::size_t axis, double asked, double sent) EBAC_RT {
    const double share = asked == 0 ? 0.0 : std::clamp(sent / asked, 0.0, 1.0);
    CommandsInFlight& commands = in_flight_[axis];
    commands.push(share * given_[static_cast<Eigen::Index>(axis)]);
    return commands[0];
  }

 private:
  Axes given_ = Axes::Zero();
  std::array<CommandsInFlight, kMaxAxes> in_flight_;
};

}  // namespace ebac
