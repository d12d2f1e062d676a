#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "ebac/gastroscope/messages.hpp"
#include "ebac/gastroscope/task.hpp"

namespace ebac::gastroscope {

using Handle = std::array<double, 3>;  // m, or N

/// From the handle to the slave's command, and from its answer to the handle.
class Master {
 public:
  Master(const MasterParams& params, double inserted) : params_(params) {
    command_.insertion = inserted;
  }

  /// `pedal` [m/s] moves the insertion where pedals do; with an open clutch the third axis moves
  /// nothing.
  const Command& command(const Handle& x, double pedal, bool clutched, double dt) EBAC_RT {
    const MasterParams& p = params_;
    if (p.bend_by_rate) {
      command_.bend_x = bent(command_.bend_x + dt * p.bend_rate * beyond(x[0]));
      command_.bend_y = bent(command_.bend_y + dt * p.bend_rate * beyond(x[1]));
    } else {
      command_.bend_x = p.bend_scale * x[0];
      command_.bend_y = p.bend_scale * x[1];
    }
    double speed = pedal;
    if (p.insertion == MasterParams::kSlideRate) speed = p.insertion_rate * beyond(x[2]);
    if (p.insertion == MasterParams::kSlideClutch)
      speed = clutched ? p.insertion_scale * (x[2] - before_) / dt : 0.0;
    before_ = x[2];
    command_.insertion = std::max(0.0, command_.insertion + dt * speed);
    return command_;
  }

  /// The insertion goes on from here [m].
  void restart(double inserted) EBAC_RT { command_.insertion = inserted; }

  /// Forces that resist the handle [N]: the power of a bend is that of its handle, times feedback.
  Handle felt(const Answer& answer, bool clutched) const EBAC_RT {
    const MasterParams& p = params_;
    const double bend = p.feedback * p.bend_scale;
    const bool slide = p.insertion == MasterParams::kSlideRate ||
                       (p.insertion == MasterParams::kSlideClutch && clutched);
    const auto within = [&](double f)
                            EBAC_RT { return std::clamp(f, -p.most_force, p.most_force); };
    return {within(bend * answer.torque_x), within(bend * answer.torque_y),
            slide ? within(p.feedback * p.push_scale * answer.push) : 0.0};
  }

 private:
  double beyond(double x) const EBAC_RT {
    return std::copysign(std::max(std::abs(x) - params_.dead_zone, 0.0), x);
  }
  static double bent(double angle) EBAC_RT { return std::clamp(angle, -4.0, 4.0); }

  MasterParams params_;
  Command command_{};
  double before_ = 0;  // m, of the third axis
};

}  // namespace ebac::gastroscope
