#include "ebac/teleop/simulate.hpp"

#include <cmath>

#include "ebac/teleop/master.hpp"

namespace ebac::teleop {

namespace {

constexpr double kFar = 1;  // m

Row row_of(double t, const MasterSide& master, const SlaveSide& slave) {
  const Port& port = master.device_port();
  const SlaveSide::State& far = slave.state();
  return {.t = t,
          .x = port.x,
          .v = port.v,
          .asked = master.asked_now(),
          .force = port.f_applied,
          .work = port.work,
          .damped = port.damped,
          .true_x = master.truth().x,
          .hand = master.truth().f_hand,
          .energy = master.truth().energy,
          .target = far.target,
          .slave_x = far.x,
          .slave_v = far.v,
          .slave_force = far.force,
          .met = far.met,
          .drift = far.drift,
          .given = slave.given(),
          .master_in = master.port().in,
          .master_out = master.port().out,
          .master_allowed = master.port().allowed,
          .dissipated = master.port().dissipated,
          .slave_in = slave.port().in,
          .slave_out = slave.port().out,
          .slave_allowed = slave.port().allowed,
          .network = master.truth().energy - slave.given(),
          .master_state = static_cast<int>(master.watch().state()),
          .slave_state = static_cast<int>(slave.watch().state()),
          .session = static_cast<int>(master.session()),
          .fault = master.sample().fault};
}

}  // namespace

Outcome simulate(const Teleop& teleop, const AnyLaw& law) {
  MasterSide master(teleop.setup, law, teleop.coupling);
  const double dt = teleop.setup.timing.dt;
  SlaveSide slave(teleop.slave, teleop.coupling, dt);
  Channel<Packet> there(teleop.there, dt, teleop.setup.seed, /*stream=*/11);
  Channel<Packet> back(teleop.back, dt, teleop.setup.seed, /*stream=*/12);
  const auto send = [](Channel<Packet>& channel, const Packet& packet) { channel.send(packet); };
  const auto ticks = static_cast<std::size_t>(std::llround(teleop.setup.seconds / dt)) + 1;
  Outcome outcome;
  outcome.rows.reserve(ticks);
  double returned = 0;
  for (std::size_t i = 0; i < ticks; ++i) {
    const double t = static_cast<double>(i) * dt;
    const auto stamp = static_cast<std::int64_t>(std::llround(t * 1e9));
    back.deliver([&](const Packet& packet) { master.take(packet); });
    returned = master.watch().state() == LinkState::kBack ? returned + dt : 0.0;
    if (returned > teleop.consent_after) master.consent();
    send(there, master.step(stamp));
    there.deliver([&](const Packet& packet) { slave.take(packet); });
    send(back, slave.step(stamp));
    outcome.rows.push_back(row_of(t, master, slave));
    if (!(std::abs(master.truth().x) < kFar) || master.sample().fault != Fault::kNone) break;
  }
  outcome.whole = outcome.rows.size() == ticks && master.sample().fault == Fault::kNone;
  outcome.at_master = master.receiver().arrivals();
  outcome.at_slave = slave.receiver().arrivals();
  return outcome;
}

}  // namespace ebac::teleop
