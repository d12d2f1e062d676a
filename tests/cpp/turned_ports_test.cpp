#include "ebac/control/turned_ports.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>

#include "ebac/control/ebac.hpp"
#include "ebac/control/lag_compensator.hpp"
#include "ebac/control/per_axis.hpp"
#include "ebac/model/noise.hpp"
#include "rounds.hpp"

namespace ebac::turned_ports_test {
namespace {

/// A contact as worlds give it: none, or a push along the x axis or along another normal.
ContactForce some_contact(Noise& random) {
  const double kind = random.symmetric();
  if (kind < -0.3) return {};
  if (kind < 0) return ContactForce::straight({3, 0, 0});
  const double angle = 3 * random.symmetric();
  return ContactForce::along_normal({std::cos(angle), std::sin(angle), 0}, 3);
}

TEST(TurnedPorts, PlacesGoOnWhateverIsMetAndWorkIsThatOfTheDevice) {
  Noise random(4);
  for (int run = 0; run < rounds(200); ++run) {
    TurnedPorts ports;
    std::array<Axis, 2> axes{};
    std::array<double, 2> last{};
    for (int tick = 0; tick < 50; ++tick) {
      double work = 0;
      for (Axis& axis : axes) {
        Port& port = axis.port;
        port.dx = tick > 0 ? 1e-3 * random.normal() : 0.0;
        port.x += port.dx;
        port.est.dx = port.dx;
        port.est.x = port.x + 1e-5 * random.normal();
        port.f_applied = random.normal();
        work += port.f_applied * port.dx;
      }
      double taken = 0;
      ports.step(std::span(axes), some_contact(random), 1,
                 [&](std::size_t i, const Port& port, double misplaced) {
                   if (tick > 0) EXPECT_NEAR(port.x - last[i], port.dx, 1e-12) << "tick " << tick;
                   last[i] = port.x;
                   taken += port.f_applied * port.dx + misplaced;
                   return 0.0;
                 });
      EXPECT_NEAR(taken, work, 1e-12);
    }
  }
}

TEST(TurnedPorts, WhileNothingIsMetTheDirectionsStay) {
  TurnedPorts ports;
  std::array<Axis, 2> axes{};
  std::array<double, 2> applied{};
  const auto ask = [&](std::size_t i, const Port& port, double) {
    applied[i] = port.f_applied;
    return i == 0 ? 2.0 : 0.0;
  };
  ports.step(std::span(axes), ContactForce::along_normal({0, 1, 0}, 3), 1, ask);
  axes[1].port.f_applied = 3;  // in flight when the hand has left
  ports.step(std::span(axes), {}, 1, ask);
  EXPECT_EQ(applied[0], 3);
  EXPECT_EQ(axes[0].port.f_cmd, 0);
  EXPECT_EQ(axes[1].port.f_cmd, 2);
  ports.step(std::span(axes), ContactForce::straight({3, 0, 0}), 1, ask);  // met along x now
  EXPECT_EQ(applied[0], 0);
  EXPECT_EQ(axes[0].port.f_cmd, 2);
}

TEST(TurnedPorts, WorkOfACommandBelongsToTheDirectionInWhichItWasGiven) {
  TurnedPorts ports;
  std::array<Axis, 2> axes{};
  std::array<double, 2> work{};
  const auto ask = [&](std::size_t i, const Port& port, double misplaced) {
    work[i] = port.f_applied * port.dx + misplaced;
    return i == 0 ? 2.0 : 0.0;
  };
  const auto along = [](double angle) {
    return ContactForce::along_normal({std::cos(angle), std::sin(angle), 0}, 2);
  };
  ports.step(std::span(axes), along(0.3), 1, ask);
  ports.step(std::span(axes), along(0.5), 1, ask);
  axes[0].port.f_applied = 2 * std::cos(0.3);  // the first command
  axes[1].port.f_applied = 2 * std::sin(0.3);
  axes[0].port.dx = 1e-3;
  ports.step(std::span(axes), along(0.8), 1, ask);
  EXPECT_NEAR(work[0], 2 * std::cos(0.3) * 1e-3, 1e-15);
  EXPECT_NEAR(work[1], 0, 1e-15);
}

/// Greatest error of the command [N] while the directions of a contact at rest turn by 2 rad/s.
template <class Law>
double error_while_turning(const Law& law) {
  PerAxis<Law> laws(law);
  std::array<Axis, 2> axes{};
  const Axes push(10, 2, 0);
  double error = 0;
  for (int tick = 0; tick < 5000; ++tick) {
    const double angle = 2e-3 * std::max(0, tick - 4000);
    ContactForce contact = ContactForce::along_normal(Axes(std::cos(angle), std::sin(angle), 0), 1);
    contact.set_force(push);
    contact.shared = contact.turned = true;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      Port& port = axes[i].port;
      port.dt = tick > 0 ? 1e-3 : 0.0;
      port.est.weight = 1;
      port.f_applied = port.f_cmd;
    }
    laws.step(std::span(axes), contact);
    for (int i = 0; tick >= 4000 && i < 2; ++i) {
      error = std::max(error, std::abs(axes[static_cast<std::size_t>(i)].port.f_cmd - push[i]));
    }
  }
  return error;
}

TEST(TurnedPorts, WhatALawRemembersOfAForceTurnsWithTheDirections) {
  EXPECT_LT(error_while_turning(LagCompensator({})), 1e-9);
  EXPECT_LT(error_while_turning(Ebac({.guard = false})), 1e-9);
}

}  // namespace
}  // namespace ebac::turned_ports_test
