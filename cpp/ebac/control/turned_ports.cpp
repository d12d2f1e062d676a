#include "ebac/control/turned_ports.hpp"

namespace ebac {

template <class Of>
Axes TurnedPorts::turn(std::span<const Axis> axes, Of of) const EBAC_RT {
  Axes all = Axes::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i)
    all[static_cast<Eigen::Index>(i)] = of(axes[i].port);
  return frame_ * all;
}

/// The ways go on from the places that the laws had before.
void TurnedPorts::begin(std::span<const Axis> axes) EBAC_RT {
  turned_ = true;
  given_.fill(Jacobian::Identity());
  for (std::size_t i = 0; i < axes.size(); ++i) port_[i].x = axes[i].port.x - axes[i].port.dx;
}

void TurnedPorts::enter(std::span<const Axis> axes, const ContactForce& contact) EBAC_RT {
  if (!turned_) begin(axes);
  if (contact.turned || !contact.along.isZero(0)) frame_ = contact.frame;
  const auto turned = [&](double Port::* member) EBAC_RT {
    return turn(axes, [member](const Port& p) EBAC_RT { return p.*member; });
  };
  Axes dx = turned(&Port::dx);
  const double rounding = 1e-12 * dx.norm();
  dx = (dx.array().abs() < rounding).select(0, dx);  // counts that cancel are no motion
  const Axes v = turned(&Port::v);
  const Axes applied = turned(&Port::f_applied);
  const Axes measured = turned(&Port::f_meas);
  const Axes surface = turned(&Port::world_v);
  const Axes moved = turn(axes, [](const Port& p) EBAC_RT { return p.est.dx; });
  const Axes estimated = turn(axes, [](const Port& p) EBAC_RT { return p.est.v; });
  const Axes predicted = turn(axes, [](const Port& p) EBAC_RT { return p.est.v_act; });
  const Axes offset = turn(axes, [](const Port& p) EBAC_RT { return p.est.x - p.x; });
  const Axes ahead = turn(axes, [](const Port& p) EBAC_RT { return p.est.x_act - p.est.x; });
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto e = static_cast<Eigen::Index>(i);
    Port& port = port_[i];
    port.x += dx[e];
    port.dx = dx[e];
    port.v = v[e];
    port.dt = axes[i].port.dt;
    port.f_env = contact.along[e];
    port.f_applied = applied[e];
    port.f_meas = measured[e];
    port.world_v = surface[e];
    port.est = axes[i].port.est;
    port.est.dx = moved[e];
    port.est.v = estimated[e];
    port.est.v_act = predicted[e];
    port.est.x = port.x + offset[e];
    port.est.x_act = port.est.x + ahead[e];
  }
}

Axes TurnedPorts::work_misplaced(std::span<const Axis> axes, int delay) EBAC_RT {
  const int size = static_cast<int>(given_.size());
  const Jacobian& acting = given_[static_cast<std::size_t>((last_ + size - delay) % size)];
  Axes misplaced = Axes::Zero();
  if (acting != frame_) {
    Axes force = Axes::Zero(), moved = Axes::Zero();
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const Port& port = axes[i].port;
      const auto e = static_cast<Eigen::Index>(i);
      force[e] = port.f_applied;
      moved[e] = port.dx + port.est.weight * (port.est.dx - port.dx);
    }
    misplaced = (acting * force).cwiseProduct(acting * moved) -
                (frame_ * force).cwiseProduct(frame_ * moved);
  }
  last_ = (last_ + 1) % size;
  given_[static_cast<std::size_t>(last_)] = frame_;
  return misplaced;
}

void TurnedPorts::leave(std::span<Axis> axes) const EBAC_RT {
  Axes f = Axes::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i) f[static_cast<Eigen::Index>(i)] = port_[i].f_cmd;
  const Axes back = frame_.transpose() * f;
  for (std::size_t i = 0; i < axes.size(); ++i)
    axes[i].port.f_cmd = back[static_cast<Eigen::Index>(i)];
}

}  // namespace ebac
