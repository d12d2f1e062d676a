#pragma once

#include <array>
#include <span>

#include "ebac/core/sample.hpp"
#include "ebac/model/contact_force.hpp"

namespace ebac {

/// The ports of a device in the directions of the world. Work is the same in both, F dx = sum F_i
/// dx_i, also where the frame turns from tick to tick: x is then the way travelled along a
/// direction, not a coordinate.
///
/// An account counts from x to x, and a hand that leaves a body does so under commands still in flight. So once a
/// contact was turned, x stays a way, and while nothing is met the directions are those of the last contact.
class TurnedPorts {
 public:
  /// Computes the force in every direction, `ask(i, port)`, and turns it back to the device axes.
  template <std::size_t N, class Ask>
  void step(std::span<Axis, N> axes, const ContactForce& contact, Ask ask) EBAC_RT {
    if (axes.size() > 1 && (turned_ || contact.turned)) {
      enter(axes, contact);
      for (std::size_t i = 0; i < axes.size(); ++i) port_[i].f_cmd = ask(i, port_[i]);
      leave(axes);
    } else {
      for (std::size_t i = 0; i < axes.size(); ++i) axes[i].port.f_cmd = ask(i, axes[i].port);
    }
  }

 private:
  void begin(std::span<const Axis> axes) EBAC_RT;
  void enter(std::span<const Axis> axes, const ContactForce& contact) EBAC_RT;
  void leave(std::span<Axis> axes) const EBAC_RT;
  template <class Of>
  Axes turn(std::span<const Axis> axes, Of of) const EBAC_RT;

  std::array<Port, kMaxAxes> port_{};
  Jacobian frame_ = Jacobian::Identity();  // of the last contact
  bool turned_ = false;  // whether there was one in other directions than the axes of the device
};

}  // namespace ebac
