// A million invalid frames, a quarter of them under sanitizers, into the loop's side of the bus. Whatever comes, the
// device keeps its promises: no torque after a fault, none beyond the limit, counters that only grow.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "ebac/canopen/canopen_device.hpp"
#include "ebac/model/noise.hpp"
#include "rounds.hpp"
#include "scripted_drives.hpp"

namespace ebac::can::canopen_fuzz_test {
namespace {

constexpr int kFrames = rounds(1'000'000);

/// Frames from anything to almost right.
class Chaos {
 public:
  explicit Chaos(std::uint64_t seed) : random_(seed) {}

  std::uint64_t below(std::uint64_t n) { return random_.bits() % n; }
  bool once_in(std::uint64_t n) { return below(n) == 0; }

  Frame frame() {
    Frame made{.id = id(), .size = static_cast<std::uint8_t>(once_in(4) ? below(9) : 8)};
    for (std::uint8_t& byte : made.data) byte = static_cast<std::uint8_t>(random_.bits());
    made.extended = once_in(50);
    made.remote = once_in(50);
    made.error = once_in(50);
    if (once_in(3)) put(made.data, 0, std::uint16_t{0x27});  // enabled, wherever it is
    return made;
  }

  /// One bit turned, or bytes lost.
  void spoil(Frame& frame) {
    frame.data[below(8)] ^= static_cast<std::uint8_t>(1U << below(8));
    if (once_in(8)) frame.size = static_cast<std::uint8_t>(below(9));
    if (once_in(16)) frame.id ^= static_cast<std::uint32_t>(1U << below(11));
  }

 private:
  std::uint32_t id() {
    static constexpr std::array<std::uint32_t, 6> kFunctions{0x180, 0x080, 0x700, 0x580, 0x200, 0};
    if (once_in(4)) return static_cast<std::uint32_t>(below(0x800));
    return kFunctions[below(kFunctions.size())] + static_cast<std::uint32_t>(below(4));
  }

  Noise random_;
};

std::int64_t trouble(const BusRow& row) {
  return row.missing + row.late + row.duplicate + row.malformed + row.foreign + row.refused;
}

class Fuzz : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Fuzz, FramesOfAnyKindMoveNothingTheyShouldNot) {
  Chaos chaos(GetParam());
  ScriptedBus bus;
  ScriptedDrives drives{.bus = &bus, .nodes = 2};
  const CanopenSetup setup{
      .axes = 2, .silent_ticks = 3, .enable_ticks = 50, .heartbeat_timeout = 0.5};
  const TorqueScale scale = TorqueScale::of(setup.motor, setup.drive);
  CanopenDevice<ScriptedBus, RunOther<ScriptedDrives>> device(bus, RunOther(drives), setup);
  // Half of the runs are mostly well, so that drives are enabled and faults can be lost again.
  std::uint64_t calm = 1;
  int runs = 0;
  int faults = 0;
  bool was_running = false;
  std::array<std::int64_t, 2> before{};
  for (int frames = 0; frames < kFrames;) {
    if (chaos.once_in(2000)) calm = chaos.once_in(2) ? 1 : 200;
    for (std::uint64_t n = calm > 1 ? chaos.once_in(calm) : chaos.below(20); n > 0; --n, ++frames) {
      bus.waiting.push_back(chaos.frame());
    }
    if (chaos.once_in(10)) {  // the heartbeats of drives that are well
      for (const NodeId node : {NodeId{1}, NodeId{2}})
        bus.waiting.push_back(frame(heartbeat(node), {5}));
    }
    for (Frame& frame : bus.waiting) {
      if (chaos.once_in(4 * calm)) chaos.spoil(frame);
    }
    if (calm > 1) ++frames;  // the drives' own
    bus.full = chaos.once_in(calm * 100);
    for (auto& drive : drives.drive) drive.copies = chaos.once_in(calm * 5) ? 0 : 1;
    if (!device.running() && chaos.once_in(20)) device.enable();

    const bool faulted = device.fault() != Fault::kNone;
    const Reading reading = device.exchange(
        {.current = {chaos.once_in(9) ? std::nan("") : 1e3, -0.5}, .elapsed = 1e-3});

    for (std::size_t i = 0; i < 2; ++i) {
      const BusRow& row = device.state(i);
      ASSERT_LE(std::abs(row.target_permille), 4000);
      if (faulted || !was_running) {
        ASSERT_EQ(row.target_permille, 0);
      }
      ASSERT_TRUE(std::isfinite(reading.current_applied[i]));
      ASSERT_EQ(reading.current_applied[i],
                scale.current(static_cast<std::int16_t>(row.actual_permille)));
      ASSERT_GE(trouble(row), before[i]);
      ASSERT_GE(row.age, 0);
      ASSERT_EQ(row.foreign, device.state(0).foreign);
      before[i] = trouble(row);
    }
    ASSERT_EQ(reading.fault, device.fault());
    if (faulted) {
      ASSERT_EQ(reading.fault, device.fault());
      ASSERT_FALSE(device.running());
    }
    runs += device.running() && !was_running ? 1 : 0;
    faults += !faulted && device.fault() != Fault::kNone ? 1 : 0;
    was_running = device.running();
  }
  EXPECT_GT(runs, 25) << "the drives were hardly ever enabled: this fuzz shows nothing";
  EXPECT_GT(faults, 25);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Fuzz, testing::Values(1, 2));

}  // namespace
}  // namespace ebac::can::canopen_fuzz_test
