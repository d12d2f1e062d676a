#pragma once

#include <cmath>
#include <span>

#include "ebac/control/per_axis.hpp"
#include "ebac/core/clock.hpp"
#include "ebac/core/controller.hpp"
#include "ebac/core/device.hpp"
#include "ebac/loop/signal_chain.hpp"

namespace ebac {

/// The first stage of the tick that gave this axis no finite number.
inline Fault first_fault(const Axis& axis) EBAC_RT {
  const Port& port = axis.port;
  const double tau = axis.joint.tau;
  // A value that is not finite makes the sum not finite; only then look for its stage.
  const double known = (port.x + port.v) + (port.f_applied + port.f_meas);
  const double sum = known + (port.f_env + (port.f_cmd + tau));
  if (std::isfinite(sum)) return Fault::kNone;
  if (!std::isfinite(port.x) || !std::isfinite(port.v)) return Fault::kPositionNotFinite;
  if (!std::isfinite(port.f_applied)) return Fault::kDevice;
  if (!std::isfinite(port.f_meas)) return Fault::kForceNotFinite;
  if (!std::isfinite(port.f_env)) return Fault::kEnvironmentNotFinite;
  if (!std::isfinite(port.f_cmd)) return Fault::kLawNotFinite;
  return std::isfinite(tau) ? Fault::kNone : Fault::kTorqueNotFinite;
}

/// The same over all axes. Faults are numbered in the order of the tick: the smallest came first.
inline Fault first_fault(std::span<const Axis> axes) EBAC_RT {
  Fault first = Fault::kNone;
  for (const Axis& axis : axes) {
    const Fault fault = first_fault(axis);
    if (first == Fault::kNone || (fault != Fault::kNone && fault < first)) first = fault;
  }
  return first;
}

/// One function for each device, whatever the law, so that a bus and its drives are compiled once.
template <Device D>
[[gnu::noinline]] Reading exchange_with(D& device, const Command& command) EBAC_RT {
  return device.exchange(command);
}

/// The device's part of a tick: currents of the last one out, then counts to ports.
template <Device D, std::size_t N>
Reading sense(SignalChain& chain, D& device, const Instant& now, Sample& s,
              std::span<Axis, N> axes) EBAC_RT {
  s.t = now.t;
  s.lateness = now.lateness;
  s.skipped = static_cast<int>(now.skipped);

  Command command{.elapsed = now.dt};
  for (std::size_t i = 0; i < axes.size(); ++i) command.current[i] = axes[i].joint.current;
  const Reading reading = exchange_with(device, command);

  chain.measure(reading, now.dt, axes);
  chain.forward(reading, now.dt, axes);
  chain.observe(reading, now.dt, axes);
  return reading;
}

/// The law's part: ports to currents.
template <AxesController Law, std::size_t N>
void render(SignalChain& chain, Law& law, const Instant& now, std::span<Axis, N> axes) EBAC_RT {
  chain.account(axes);
  const ContactForce contact = chain.contact(now.t, axes);
  chain.show_own_force(axes);
  law.step(axes, contact);
  chain.show_whole_force(axes);
  chain.heed(drained_of(law), now.dt, axes);
  chain.drive(now.dt, axes);
}

/// Zero force requested and commanded.
inline void rest(std::span<Axis> axes) EBAC_RT {
  for (Axis& axis : axes) {
    axis.port.f_env = axis.port.f_cmd = axis.joint.tau = axis.joint.current = 0;
  }
}

/// The first fault that the device or a stage reports.
inline Fault judge(const Reading& reading, std::span<const Axis> axes) EBAC_RT {
  return reading.fault != Fault::kNone ? reading.fault : first_fault(axes);
}

/// One tick without limits, pauses and a row, as a sweep and a gastroscopy take it; `Loop` has all of
/// them. Commands computed here act `delay` ticks later, in simulation and on the bus alike.
template <AxesController Law, Device D, std::size_t N>
void tick(SignalChain& chain, Law& law, D& device, const Instant& now, Sample& s,
          std::span<Axis, N> axes) EBAC_RT {
  const Reading reading = sense(chain, device, now, s, axes);
  render(chain, law, now, axes);
  if (s.fault == Fault::kNone) s.fault = judge(reading, axes);
  if (s.fault != Fault::kNone) {  // from here on, zero force
    for (Axis& axis : axes) axis.port.f_cmd = axis.joint.tau = axis.joint.current = 0;
    s.ramp = 0;
    chain.sent_with(0);
  }
}

/// A device without input and output. Its tick with one axis, the usual case, is compiled as a
/// single function with all its calls inlined: a sixth less time.
template <class D>
concept Quick = Device<D> && D::kQuick;

inline std::span<Axis> axes_in_use(Sample& s) EBAC_RT {
  return {s.axis.data(), static_cast<std::size_t>(s.axes)};
}
inline std::span<Axis, 1> only_axis(Sample& s) EBAC_RT { return std::span(s.axis).first<1>(); }

template <AxesController Law, Device D>
EBAC_ONE_FUNCTION void tick_one(SignalChain& chain, Law& law, D& device, const Instant& now,
                                Sample& s) EBAC_RT {
  tick(chain, law, device, now, s, only_axis(s));
}

template <AxesController Law, Device D>
void tick(SignalChain& chain, Law& law, D& device, const Instant& now, Sample& s) EBAC_RT {
  if constexpr (Quick<D>) {
    if (s.axes == 1) return tick_one(chain, law, device, now, s);
  }
  tick(chain, law, device, now, s, axes_in_use(s));
}

}  // namespace ebac
