#include "ebac/model/exact_plant.hpp"

#include <cmath>
#include <stdexcept>

namespace ebac {

namespace {

/// A lag below 1 ns counts as none: the digits of the exponential would all go to its rate.
double resolved(double lag) { return lag < 1e-9 ? 0.0 : lag; }

}  // namespace

AxisParameters axis_parameters(const DeviceModel& device, const Hand& hand) {
  return {.device_mass = device.mass(),
          .device_damping = device.mechanics.damping,
          .coulomb = device.mechanics.coulomb,
          .weight = device.mechanics.handle_mass * device.mechanics.gravity,
          .carried = device.compensation.gravity_mass * device.mechanics.gravity,
          .current_lag = resolved(device.drive.current_lag),
          .sensor_lag = resolved(device.sensor.lag),
          .hand_mass = hand.mass,
          .hand_damping = hand.damping,
          .hand_stiffness = hand.stiffness};
}

bool ExactPlant::covers(const DeviceModel& device) {
  return std::holds_alternative<Linear>(device.kinematics) && !device.mechanics.stribeck() &&
         !device.mechanics.compliant();
}

ExactPlant::ExactPlant(const DeviceModel& device, const Hand& hand, double tick)
    : hand_(hand),
      tick_(tick),
      force_per_amp_(device.force(1)),
      angle_per_metre_(device.capstan.ratio() / device.radius()) {
  if (!covers(device)) {
    throw std::invalid_argument(
        "ExactPlant: needs Linear kinematics without breakaway friction, cable compliance and "
        "backlash; use the stepped plant");
  }
  if (!hand.linear()) {
    throw std::invalid_argument("ExactPlant: needs a hand without a model; use the stepped plant");
  }
  const auto n = static_cast<std::size_t>(device.axes());
  axes_.assign(n, ExactAxis(axis_parameters(device, hand), tick));
  if (std::isfinite(hand.release_at)) {
    without_hand_.assign(
        n, ExactAxis(axis_parameters(device, {.mass = 0, .damping = 0, .stiffness = 0}), tick));
  }
}

void ExactPlant::let_go() EBAC_RT {
  for (std::size_t i = 0; i < axes_.size(); ++i) without_hand_[i].take_over(axes_[i]);
  axes_.swap(without_hand_);
  released_ = true;
}

}  // namespace ebac
