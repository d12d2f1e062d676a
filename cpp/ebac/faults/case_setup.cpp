#include "ebac/faults/case_setup.hpp"

#include <algorithm>

#include "ebac/faults/faulty_parts.hpp"
#include "ebac/faults/wiring.hpp"

namespace ebac::faults {

namespace {

/// Random numbers of a case.
class Between {
 public:
  explicit Between(const InjectedFault& injected) : random_(injected.chance, /*stream=*/7) {}
  double operator()(double low, double high) {
    return low + (high - low) * (0.5 + 0.5 * random_.symmetric());
  }

 private:
  Noise random_;
};

void move(Setup& setup, double start, const MinimumJerk& one, const MinimumJerk& other) {
  setup.hand.path[0] = one;
  setup.hand.path[1] = other;
  for (std::size_t i = 0; i < 2; ++i) std::get<MinimumJerk>(setup.hand.path[i]).at += start;
}

/// A hand that moves into a slanting wall: both axes push.
void press(Setup& setup, double start, const InjectedFault& injected, Between& between) {
  setup.environment = Wall{.stiffness = between(2e3, 20e3), .position = 0.01, .angle = 0.6};
  const double target = between(0.015, 0.035);
  MinimumJerk one{.target = target, .at = 0.01, .duration = between(0.1, 0.2)};
  MinimumJerk other{.target = target, .at = 0.03, .duration = between(0.1, 0.2)};
  if (injected.kind == Kind::kEncoderWrap) {
    setup.device.encoder.counter_bits = 11;  // 1024 counts are 31 mm
    setup.environment = Free{};
    one = {.target = 0.038, .at = 0.01, .duration = between(0.1, 0.15)};
  }
  if (injected.kind == Kind::kEncoderFrozen) {  // on its way, 0.3 m/s or faster
    setup.environment = Wall{.stiffness = 10e3, .position = 0.02};
    one = other = {.target = 0.035, .at = 0.01, .duration = 0.1};
  }
  move(setup, start, one, other);
}

/// A clamp instead of a hand, that goes its own way whatever the motors do.
void hold(Setup& setup, double start, const InjectedFault& injected, Between& between) {
  setup.environment = Free{};
  setup.hand.stiffness = 10e3;
  setup.hand.damping = 60;
  MinimumJerk way{.target = 0, .at = 0.02, .duration = 0.12};
  switch (injected.kind) {
    case Kind::kWorkspaceEdge:
      way.target = between(0.049, 0.055);
      way.duration = between(0.1, 0.2);
      break;
    case Kind::kWorkspaceEnd:
      way.target = between(0.0605, 0.07);
      way.duration = between(0.15, 0.25);
      break;
    case Kind::kOverspeed:
      setup.hand.stiffness = 20e3;
      way = {.target = 0.04, .at = 0.06, .duration = between(0.022, 0.03)};
      break;
    case Kind::kNanJoint:
      way.target = 0.0505;
      break;
    default:
      break;
  }
  if ((injected.chance & 1U) != 0) way.target = -way.target;
  const MinimumJerk still{.target = 0, .at = 0, .duration = 0.1};
  const bool first = injected.axis == 0;
  move(setup, start, first ? way : still, first ? still : way);
}

/// Tighter ones than the device needs, as a user may set them.
void tighten(CaseSetup& made, const InjectedFault& injected, Between& between) {
  Limits& limits = made.limits;
  const double peak = limits.peak_current;
  limits.peak_current = peak * between(0.3, 0.8);
  switch (injected.kind) {
    case Kind::kForceAtStart:
      made.plan.soft_start = between(0.03, 0.1);
      break;
    case Kind::kForceHeld:
      limits.thermal_time = between(0.05, 0.3);
      limits.slew = between(200, 2000);
      break;
    default:
      limits.peak_current = peak * between(0.3, 0.45);
      limits.slew = between(50, 800);
      break;
  }
}

}  // namespace

CaseSetup case_setup_of(const InjectedFault& injected) {
  CaseSetup made{.plan = {.soft_start = 0.02,
                          .ramp_down = 0.02,
                          .arm = true,
                          .ticks = facts_of(injected.kind).run},
                 .wiring = wiring_of(injected),
                 .watching = watching_of(injected)};
  Between between(injected);
  made.setup.seed = injected.chance;
  made.setup.device.kinematics = Linear{.axes = 2};
  // The hand waits for the drives.
  const double start = made.setup.timing.dt * (made.watching.before() - 20);
  made.limits = Limits::of(made.setup.device);
  switch (injected.kind) {
    case Kind::kForceAtStart:
    case Kind::kForceSwings:
    case Kind::kForceHeld:
    case Kind::kNanJoint:
      tighten(made, injected, between);
      [[fallthrough]];
    case Kind::kWorkspaceEdge:
    case Kind::kWorkspaceEnd:
    case Kind::kOverspeed:
    case Kind::kPause:
      hold(made.setup, start, injected, between);
      break;
    default:
      press(made.setup, start, injected, between);
      break;
  }
  made.known = made.setup.device;
  if (injected.kind == Kind::kNanTorque) {
    made.known.compensation = {.friction = 1, .friction_speed = kNoNumber};
  }
  return made;
}

}  // namespace ebac::faults
