#pragma once

#include <cmath>
#include <span>

#include "ebac/core/concepts.hpp"
#include "ebac/loop/rig.hpp"

namespace ebac {

/// Latches `fault` when a member of any port or joint is not a finite number.
template <class Part>
void require_finite(Sample& s, Part Axis::*part, double Part::*member, Fault fault) EBAC_RT {
  for (std::int64_t i = 0; i < s.axes; ++i) {
    const double value = s.axis[static_cast<std::size_t>(i)].*part.*member;
    if (!std::isfinite(value) && s.fault == Fault::kNone) s.fault = fault;
  }
}

/// One tick of the loop. What is computed here acts `delay` ticks later, in simulation and on the bus alike.
template <AxesController Law, Device D>
void tick(Rig& rig, Law& law, D& device, const Instant& now, Sample& s) EBAC_RT {
  const std::span<Axis> axes(s.axis.data(), static_cast<std::size_t>(s.axes));
  s.t = now.t;
  s.lateness = now.lateness;

  Command command{.elapsed = now.dt};
  for (std::size_t i = 0; i < axes.size(); ++i) command.current[i] = axes[i].joint.current;
  const Reading reading = device.exchange(command);
  if (reading.fault != Fault::kNone && s.fault == Fault::kNone) s.fault = reading.fault;

  rig.measure(reading, now.dt, axes);
  rig.forward(reading, now.dt, axes);
  rig.account(axes);
  require_finite(s, &Axis::port, &Port::x, Fault::kPositionNotFinite);
  require_finite(s, &Axis::port, &Port::v, Fault::kPositionNotFinite);
  require_finite(s, &Axis::port, &Port::f_meas, Fault::kForceNotFinite);

  rig.ask(axes);
  require_finite(s, &Axis::port, &Port::f_env, Fault::kEnvironmentNotFinite);

  law.step(axes);
  require_finite(s, &Axis::port, &Port::f_cmd, Fault::kLawNotFinite);

  rig.drive(now.dt, axes);
  require_finite(s, &Axis::joint, &Joint::tau, Fault::kTorqueNotFinite);

  if (s.fault != Fault::kNone) {  // from here on, zero force
    for (Axis& axis : axes) axis.port.f_cmd = axis.joint.tau = axis.joint.current = 0;
  }
}

}  // namespace ebac
