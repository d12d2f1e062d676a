#include "ebac/control/turned_ports.hpp"

namespace ebac {

namespace {

Axes turn(std::span<const Axis> axes, const ContactForce& contact, double Port::* member) EBAC_RT {
  Axes all = Axes::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i)
    all[static_cast<Eigen::Index>(i)] = axes[i].port.*member;
  return contact.frame * all;
}

template <class Of>
Axes turn_estimate(std::span<const Axis> axes, const ContactForce& contact, Of of) EBAC_RT {
  Axes all = Axes::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i)
    all[static_cast<Eigen::Index>(i)] = of(axes[i].port);
  return contact.frame * all;
}

}  // namespace

void TurnedPorts::enter(std::span<const Axis> axes, const ContactForce& contact) EBAC_RT {
  const auto turned = [&](double Port::* member) EBAC_RT { return turn(axes, contact, member); };
  Axes dx = turned(&Port::dx);
  const double rounding = 1e-12 * dx.norm();
  dx = (dx.array().abs() < rounding).select(0, dx);  // counts that cancel are no motion
  const Axes v = turned(&Port::v);
  const Axes applied = turned(&Port::f_applied);
  const Axes measured = turned(&Port::f_meas);
  const Axes surface = turned(&Port::world_v);
  const auto estimate = [&](auto of) EBAC_RT { return turn_estimate(axes, contact, of); };
  const Axes moved = estimate([](const Port& p) EBAC_RT { return p.est.dx; });
  const Axes estimated = estimate([](const Port& p) EBAC_RT { return p.est.v; });
  const Axes predicted = estimate([](const Port& p) EBAC_RT { return p.est.v_act; });
  const Axes offset = estimate([](const Port& p) EBAC_RT { return p.est.x - p.x; });
  const Axes ahead = estimate([](const Port& p) EBAC_RT { return p.est.x_act - p.est.x; });
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

void TurnedPorts::leave(std::span<Axis> axes, const ContactForce& contact) const EBAC_RT {
  Axes f = Axes::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i) f[static_cast<Eigen::Index>(i)] = port_[i].f_cmd;
  const Axes back = contact.frame.transpose() * f;
  for (std::size_t i = 0; i < axes.size(); ++i)
    axes[i].port.f_cmd = back[static_cast<Eigen::Index>(i)];
}

}  // namespace ebac
