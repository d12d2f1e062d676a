#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ebac/control/any_law.hpp"
#include "ebac/core/fields.hpp"
#include "ebac/sim/setup.hpp"
#include "ebac/teleop/channel.hpp"
#include "ebac/teleop/coupling.hpp"
#include "ebac/teleop/slave.hpp"

namespace ebac::teleop {

/// A tick of both sides.
struct Row {
  double t = 0;
  double x = 0, v = 0, asked = 0, force = 0, work = 0, damped = 0, true_x = 0, hand = 0, energy = 0;
  double target = 0, slave_x = 0, slave_v = 0, slave_force = 0, met = 0, drift = 0, given = 0;
  double master_in = 0, master_out = 0, master_allowed = 0, dissipated = 0;
  double slave_in = 0, slave_out = 0, slave_allowed = 0;
  double network = 0;
  int master_state = 0, slave_state = 0;
  int session = 1;
  Fault fault = Fault::kNone;

  static constexpr auto fields() {
    using F = Field<Row>;
    return std::array{
        F{"t", &Row::t, "s", "time"},
        F{"x", &Row::x, "m", "master, measured"},
        F{"v", &Row::v, "m/s", "master, estimated"},
        F{"asked", &Row::asked, "N", "force of the network at the master; resists +x"},
        F{"force", &Row::force, "N", "force that acted at the master over the last interval"},
        F{"work", &Row::work, "J", "energy the master's motor took from the hand"},
        F{"damped", &Row::damped, "J", "energy the master's own damping took at least"},
        F{"true_x", &Row::true_x, "m", "master, true"},
        F{"energy", &Row::energy, "J",
          "physical energy that the master's port took in, its damping counted; true"},
        F{"hand", &Row::hand, "N", "force of the hand on the master"},
        F{"target", &Row::target, "m", "where the slave's controller is held to be"},
        F{"slave_x", &Row::slave_x, "m", "slave"},
        F{"slave_v", &Row::slave_v, "m/s", "slave"},
        F{"slave_force", &Row::slave_force, "N", "force of the slave's controller; sent back"},
        F{"met", &Row::met, "N", "force of the environment on the slave"},
        F{"drift", &Row::drift, "m", "place asked for by the master less the slave's target"},
        F{"given", &Row::given, "J", "energy the network gave to the slave since the start"},
        F{"master_in", &Row::master_in, "J", "into the network at the master, this session"},
        F{"master_out", &Row::master_out, "J", "out of the network at the master, this session"},
        F{"master_allowed", &Row::master_allowed, "J",
          "went in at the slave this session, as far as the master knows; under waves, the energy "
          "of the wave that came back"},
        F{"dissipated", &Row::dissipated, "J",
          "by law, passivity controller and damping of the master, this session"},
        F{"slave_in", &Row::slave_in, "J", "into the network at the slave, this session"},
        F{"slave_out", &Row::slave_out, "J", "out of the network at the slave, this session"},
        F{"slave_allowed", &Row::slave_allowed, "J",
          "went in at the master this session, as far as the slave knows; under waves, the energy "
          "of the wave that came in"},
        F{"network", &Row::network, "J",
          "energy both ports put into the network, law and controller included: passive where "
          "never below 0"},
        F{"master_state", &Row::master_state, "1",
          "0 waiting, 1 running, 2 link lost, 3 link back"},
        F{"slave_state", &Row::slave_state, "1", "the same of the slave"},
        F{"session", &Row::session, "1", "the hand's consents so far, the first included"},
        F{"fault", &Row::fault, "1", "of the master's chain"},
    };
  }
};

struct Teleop {
  Setup setup{};
  Coupling coupling{};
  SlaveModel slave{};
  Link there{};
  Link back{};
  double consent_after = 0.5;  // s after the link is back
};

struct Outcome {
  std::vector<Row> rows;
  bool whole = false;  // neither fault nor flight ended it
  Arrivals at_master{};
  Arrivals at_slave{};
};

/// One run; it ends early where the master leaves 1 m.
Outcome simulate(const Teleop& teleop, const AnyLaw& law);

}  // namespace ebac::teleop
