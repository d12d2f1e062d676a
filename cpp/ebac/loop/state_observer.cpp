#include "ebac/loop/state_observer.hpp"

#include <algorithm>
#include <variant>

#include "ebac/model/of_all.hpp"
#include "ebac/model/pose.hpp"

namespace ebac {

StateObserver::StateObserver(const DeviceModel& device, const Observing& observing)
    : kinematics_(device.kinematics),
      linear_(std::holds_alternative<Linear>(device.kinematics)),
      travel_(travel(device.kinematics)),
      force_per_amp_(device.motor.torque_constant * device.capstan.ratio() / travel_.array()),
      handle_mass_(device.mechanics.handle_mass),
      slide_mass_(device.mass(device.axes() - 1)),
      handle_weight_(handle_mass_ * device.mechanics.gravity),
      observing_(observing),
      observer_{AxisObserver(observing.params), AxisObserver(observing.params),
                AxisObserver(observing.params)} {
  if (!linear_) return;  // the pose has it
  for (AxisObserver& observer : observer_) observer.set_weight(handle_weight_);
}

/// Only a world that stands still says what is learned of the scale: of one that moves, the force does not change with
/// the way of the device. And only a force along one axis: along an oblique wall an axis moves with the strokes of the
/// hand, and its force with what the hand does across them.
void StateObserver::teach(std::span<const Axis> axes) EBAC_RT {
  bool stands = true;
  for (const Axis& axis : axes) stands = stands && axis.port.world_v == 0;
  const auto pushing = std::ranges::count_if(observer_, &AxisObserver::pushes);
  for (AxisObserver& observer : observer_) observer.set_learns(stands && pushing == 1);
}

/// The mass of an axis over that of the first in the middle. The pose changes the handle's part of it.
double StateObserver::mass_share(const Pose& at, Eigen::Index axis) const EBAC_RT {
  const double share = at.inertia[axis] / (travel_[axis] * travel_[axis]);
  const double middle = axis == 2 ? slide_mass_ : observing_.params.mass;
  const double handle = std::min(handle_mass_, middle);  // of a mass that is declared too small
  return (middle + handle * (share - 1)) / observing_.params.mass;
}

/// With the inertia of the pose, and with what the turning and sliding of the joints do to each other.
void StateObserver::step_general(const Reading& reading, const std::array<bool, kMaxAxes>& counted,
                                 double dt, std::span<Axis> axes) EBAC_RT {
  const Axes q = of_all(axes, &Axis::joint, &Joint::q);
  const Pose here = pose(kinematics_, q, of_all(axes, &Axis::joint, &Joint::dq));
  const Axes along =
      here.j.transpose() * of_all(axes, &Axis::port, &Port::f_meas) - handle_mass_ * here.coriolis;
  Axes now = Axes::Zero(), speed = Axes::Zero(), then = Axes::Zero(), speed_then = Axes::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto e = static_cast<Eigen::Index>(i);
    observer_[i].set_mass_share(mass_share(here, e));
    observer_[i].set_weight(handle_weight_ * here.weight[e] / travel_[e]);
    const AxisObserver& observer =
        follow(i, axes[i].joint, along[e] / travel_[e], reading, counted[i], dt);
    now[e] = observer.x() / travel_[e];
    speed[e] = observer.v() / travel_[e];
    const AxisObserver::Motion ahead = observer.predict();
    then[e] = ahead.x / travel_[e];
    speed_then[e] = ahead.v / travel_[e];
  }
  const Axes x = forward(kinematics_, now);
  const Axes v = jacobian(kinematics_, now) * speed;
  const Axes x_act = forward(kinematics_, then);
  const Axes v_act = jacobian(kinematics_, then) * speed_then;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto e = static_cast<Eigen::Index>(i);
    Estimate& est = axes[i].port.est;
    est.dx = dt > 0 ? x[e] - est.x : 0.0;
    est.x = x[e];
    est.v = v[e];
    est.x_act = x_act[e];
    est.v_act = v_act[e];
    enter(i, axes[i].port);
  }
}

}  // namespace ebac
