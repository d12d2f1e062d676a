#include "ebac/sim/ideal_wall.hpp"

#include <cmath>

#include "ebac/model/exact_plant.hpp"

namespace ebac {

namespace {

AxisParameters free_parameters(const Setup& s) {
  return {.device_mass = s.device.mass(),
          .device_damping = s.device.mechanics.damping,
          .coulomb = s.device.mechanics.coulomb,
          .weight = s.device.mechanics.handle_mass * s.device.mechanics.gravity,
          .current_lag = 0,
          .sensor_lag = 0,
          .hand_mass = s.hand.mass,
          .hand_damping = s.hand.damping,
          .hand_stiffness = s.hand.stiffness};
}

/// In contact the wall is one more spring and damper beside the hand's.
AxisParameters touching_parameters(const Setup& s, const Wall& wall) {
  AxisParameters p = free_parameters(s);
  p.hand_stiffness += wall.stiffness;
  p.hand_damping += wall.damping;
  return p;
}

/// One axis between two linear motions; the events are touching and leaving, found to 2^-20 of a
/// tick by bisection over dyadic steps. Only where the axis is matters here, not whose force is
/// whose.
class IdealAxis {
 public:
  IdealAxis(const Setup& setup, const Wall& wall)
      : hand_(setup.hand),
        wall_(wall),
        tick_(setup.timing.dt),
        weight_(setup.device.compensation.gravity_mass * setup.device.mechanics.gravity),
        free_(free_parameters(setup), tick_),
        touching_(touching_parameters(setup, wall), tick_),
        before_(free_) {}

  double x() const { return axis().truth().x; }

  /// Force of the wall on the device [N].
  double force() const {
    const AxisTruth& truth = axis().truth();
    if (!touches_) return 0;
    return wall_.stiffness * (truth.x - wall_.position) + wall_.damping * truth.v;
  }

  void advance(double t) {
    const Target target = hand_.target(0, t, tick_);
    std::int64_t left = kQuanta;
    while (left > 0) {
      const double gone =
          tick_ * static_cast<double>(kQuanta - left) / static_cast<double>(kQuanta);
      follow({target.x + target.rate * gone, target.rate}, left);
      if (left > 0) change();
    }
  }

 private:
  const ExactAxis& axis() const { return touches_ ? touching_ : free_; }

  bool pushed() const {
    const AxisTruth& truth = axis().truth();
    const double depth = truth.x - wall_.position;
    return depth >= 0 && wall_.stiffness * depth + wall_.damping * truth.v > 0;
  }

  /// Follows one motion until the time is up or an event, and one quantum past it.
  void follow(Target target, std::int64_t& left) {
    ExactAxis& axis = touches_ ? touching_ : free_;
    const std::int64_t given = left;
    // Two springs in parallel pull to a point between their ends.
    const double both = hand_.stiffness + wall_.stiffness;
    const double share = touches_ && both > 0 ? hand_.stiffness / both : 1;
    const double pull = (1 - share) * wall_.position;
    const auto step = [&](std::int64_t size) {
      const double gone = tick_ * static_cast<double>(given - left) / static_cast<double>(kQuanta);
      axis.advance(weight_, share * (target.x + target.rate * gone) + pull, share * target.rate,
                   size);
    };
    for (std::int64_t size = kQuanta; size > 0 && left > 0; size /= 2) {
      while (left >= size) {
        before_.take_over(axis);
        step(size);
        if (pushed() != touches_) {
          if (size > 1) axis.take_over(before_);  // try a shorter step
          if (size == 1) --left;
          break;
        }
        left -= size;
      }
    }
  }

  void change() {
    if (pushed() == touches_) return;  // friction can end a motion just there
    (touches_ ? free_ : touching_).take_over(axis());
    touches_ = !touches_;
  }

  Hand hand_;
  Wall wall_;
  double tick_;
  double weight_;  // N, part carried by the motor
  ExactAxis free_;
  ExactAxis touching_;
  ExactAxis before_;
  bool touches_ = false;
};

const Wall* straight_wall(const Setup& setup) {
  const auto* wall = std::get_if<Wall>(&setup.environment);
  return wall != nullptr && wall->angle == 0 && wall->motion_amplitude == 0 ? wall : nullptr;
}

}  // namespace

IdealContact ideal_contact(const Setup& setup, ContactRecorder& recorder) {
  const Wall* wall = straight_wall(setup);
  if (wall == nullptr || !ExactPlant::covers(setup.device, setup.hand) ||
      std::isfinite(setup.hand.release_at)) {
    return {};
  }
  const auto rows = row_count(setup);
  if (rows < kFewestRows) return {};
  IdealAxis axis(setup, *wall);
  recorder.start(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = setup.timing.dt * static_cast<double>(i);
    recorder.add(t, 0, 0);
    recorder.add_axis(0, axis.x(), axis.force());
    axis.advance(t);
  }
  const WallContact c = measure_contact(recorder.record());
  return {
      .rest = c.rest, .swing = c.swing, .settled = c.settled, .peak = c.peak, .quiet = c.quiet()};
}

}  // namespace ebac
