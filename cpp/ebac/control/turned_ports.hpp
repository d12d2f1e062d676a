#pragma once

#include <array>
#include <span>

#include "ebac/control/commands_in_flight.hpp"
#include "ebac/core/sample.hpp"
#include "ebac/model/contact_force.hpp"

namespace ebac {

/// The ports of a device in the directions of the world. Work is the same in both, F dx = sum F_i
/// dx_i, also where the frame turns from tick to tick: x is then the way travelled along a
/// direction, not a coordinate.
///
/// An account counts from x to x, and a hand that leaves a body does so under commands still in flight. So once a
/// contact was turned, x stays a way, and while nothing is met the directions are those of the last contact.
///
/// A command acts in the direction in which it was given, `delay` samples ago, and by then the directions may have
/// turned: around a ball its force lags behind the normal. The sum of F_i dx_i is still the work, but some of the work of
/// a direction shows in another one.
class TurnedPorts {
 public:
  /// Computes the force in every direction, `ask(i, port, misplaced)`, and turns it back to the device axes. `misplaced`
  /// is the work [J] of the commands of direction i over the last interval that F_i dx_i does not show, of commands that
  /// act after `delay` samples.
  template <std::size_t N, class Ask>
  void step(std::span<Axis, N> axes, const ContactForce& contact, int delay, Ask ask) EBAC_RT {
    if (axes.size() > 1 && (turned_ || contact.turned)) {
      enter(axes, contact);
      const Axes misplaced = work_misplaced(axes, delay);
      for (std::size_t i = 0; i < axes.size(); ++i)
        port_[i].f_cmd = ask(i, port_[i], misplaced[static_cast<Eigen::Index>(i)]);
      leave(axes);
    } else {
      for (std::size_t i = 0; i < axes.size(); ++i) axes[i].port.f_cmd = ask(i, axes[i].port, 0.0);
    }
  }

 private:
  void begin(std::span<const Axis> axes) EBAC_RT;
  void enter(std::span<const Axis> axes, const ContactForce& contact) EBAC_RT;
  Axes work_misplaced(std::span<const Axis> axes, int delay) EBAC_RT;
  void leave(std::span<Axis> axes) const EBAC_RT;
  template <class Of>
  Axes turn(std::span<const Axis> axes, Of of) const EBAC_RT;

  std::array<Port, kMaxAxes> port_{};
  Jacobian frame_ = Jacobian::Identity();  // of the last contact
  bool turned_ = false;  // whether there was one in other directions than the axes of the device
  std::array<Jacobian, kMaxDelay + 1> given_;  // frames of the commands up to the last, in a ring
  int last_ = 0;                               // where that one is
};

}  // namespace ebac
