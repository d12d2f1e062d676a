#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>

#include "designed_law.hpp"
#include "ebac/sim/any_law.hpp"

namespace ebac::replay_test {
namespace {

/// The log of a run, as a recorder would have kept it.
std::shared_ptr<ReplayLog> log_of(const Trace& trace) {
  auto log = std::make_shared<ReplayLog>();
  log->axes = static_cast<std::size_t>(trace.axes());
  for (std::size_t i = 0; i < trace.size(); ++i) {
    const Sample s = trace.sample(i);
    log->row.push_back({.instant = {s.t, s.axis[0].port.dt, s.lateness}});
    for (std::size_t a = 0; a < log->axes; ++a) {
      const auto& [joint, port] = s.axis[a];
      log->axis.push_back({.counts = joint.counts,
                           .current_applied = joint.current_applied,
                           .force = port.f_meas,
                           .recorded = {port.f_env, port.f_cmd, joint.current}});
    }
  }
  return log;
}

Setup two_axes() {
  Setup setup;
  setup.device.kinematics = Linear{.axes = 2};
  setup.device.encoder.counter_bits = 10;  // wraps during the run
  setup.jitter = 0.2;
  setup.seconds = 0.5;
  return setup;
}

TEST(Replay, TheSameLawCommandsTheSameBits) {
  const auto setup = two_axes();
  const auto law = designed_law("ebac", setup);
  const auto recorded = simulate_any(setup, law);
  const auto again = replay_any(log_of(*recorded), law, setup.device, setup.environment);
  ASSERT_EQ(again->size(), recorded->size());
  for (std::size_t i = 0; i < recorded->size(); ++i) {
    const std::byte* was = recorded->data() + i * recorded->row_bytes() + offsetof(Sample, axis);
    const std::byte* is = again->data() + i * again->row_bytes() + offsetof(Sample, axis);
    ASSERT_EQ(std::memcmp(was, is, 2 * sizeof(Axis)), 0) << "row " << i;
  }
}

TEST(Replay, AnotherLawMovesNothing) {
  const auto setup = two_axes();
  const auto recorded = simulate_any(setup, designed_law("ebac", setup));
  const auto other =
      replay_any(log_of(*recorded), designed_law("tca", setup), setup.device, setup.environment);
  bool differs = false;
  for (std::size_t i = 0; i < recorded->size(); ++i) {
    const Axis was = recorded->sample(i).axis[0];
    const Axis is = other->sample(i).axis[0];
    ASSERT_EQ(was.port.x, is.port.x);
    ASSERT_EQ(was.port.f_applied, is.port.f_applied);
    differs |= was.port.f_cmd != is.port.f_cmd;
  }
  EXPECT_TRUE(differs);
}

TEST(Replay, TheFaultOfTheDeviceComesInItsTick) {
  const auto setup = two_axes();
  const auto law = designed_law("ebac", setup);
  const auto log = log_of(*simulate_any(setup, law));
  log->row[100].fault = Fault::kDriveSilent;
  const auto again =
      replay_any(std::shared_ptr<const ReplayLog>(log), law, setup.device, setup.environment);
  EXPECT_EQ(again->size(), 110u);
  EXPECT_EQ(again->sample(99).fault, Fault::kNone);
  EXPECT_EQ(again->sample(100).fault, Fault::kDriveSilent);
  EXPECT_EQ(again->sample(100).axis[0].port.f_cmd, 0);
}

TEST(Replay, BeyondItsEndALogStandsStill) {
  const auto log = log_of(*simulate_any(two_axes(), designed_law("ebac", two_axes())));
  ReplayDevice device(log);
  for (std::size_t i = 0; i < log->rows() + 5; ++i) device.exchange({});
  EXPECT_EQ(device.exchange({}).counts[0], log->axis[(log->rows() - 1) * 2].counts);
}

}  // namespace
}  // namespace ebac::replay_test
