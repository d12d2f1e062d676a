// Parameter updates: one writer, one reader, no waiting; values arrive whole, in order, the newest one.
#include "ebac/loop/parameter_updates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <thread>

#include "ebac/control/tca.hpp"
#include "ebac/sim/simulate.hpp"

namespace ebac::parameter_updates_test {
namespace {

TEST(Mailbox, IsEmptyUntilSomethingIsPosted) {
  Mailbox<int> box(7);
  EXPECT_EQ(box.take(), nullptr);
  box.post(1);
  box.post(2);
  const int* got = box.take();
  ASSERT_NE(got, nullptr);
  EXPECT_EQ(*got, 2);  // 1 was replaced before it was taken
  EXPECT_EQ(box.take(), nullptr);
  EXPECT_EQ(*got, 2);  // and stays while nothing is taken
}

/// The memory may be another process's, too, which may write anything.
TEST(Mailbox, StaysWithinItsSlotsWhateverItsIndicesBecome) {
  struct {
    Mailbox<int> box;
    std::array<int, 8> behind{};
  } here;
  const auto* first = reinterpret_cast<const std::byte*>(&here.box);
  for (int value = 0; value < 256; ++value) {
    std::memset(static_cast<void*>(&here.box), value, sizeof(here.box));
    here.box.post(1);
    for (int i = 0; i < 3; ++i) {
      const auto* taken = reinterpret_cast<const std::byte*>(here.box.take());
      if (taken == nullptr) continue;
      EXPECT_LT(static_cast<std::size_t>(taken - first), 3 * sizeof(int)) << value;
      here.box.post(1);
    }
  }
  EXPECT_EQ(here.behind, (std::array<int, 8>{}));
}

TEST(Mailbox, NeverTearsAValueBetweenThreads) {
  using Block = std::array<std::uint64_t, 32>;
  constexpr std::uint64_t kLast = 20'000;
  Mailbox<Block> box;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      Block block;
      block.fill(i);
      box.post(block);
    }
  });
  std::uint64_t seen = 0;
  while (seen < kLast) {
    const Block* block = box.take();
    if (block == nullptr) {
      std::this_thread::yield();
      continue;
    }
    for (const std::uint64_t one : *block) ASSERT_EQ(one, (*block)[0]);
    ASSERT_GT((*block)[0], seen);
    seen = (*block)[0];
  }
  writer.join();
  EXPECT_EQ(seen, kLast);
}

TEST(AppliedUpdates, KeepsWhatWasNotReadWhateverIsAskedFor) {
  constexpr std::size_t kMost = AppliedUpdates::kMost;
  const auto serial = [](std::size_t i) { return static_cast<std::uint64_t>(i); };
  AppliedUpdates updates;
  for (std::size_t i = 0; i < kMost; ++i) updates.add({.serial = serial(i)});
  updates.read(kMost);
  for (std::size_t i = 0; i < 10; ++i) updates.add({.serial = serial(kMost + i)});
  updates.read(0);  // those are gone
  EXPECT_EQ(updates.first(), kMost);
  for (std::size_t i = 10; i < kMost + 5; ++i) updates.add({.serial = serial(kMost + i)});
  EXPECT_EQ(updates.lost(), 5U);
  ASSERT_EQ(updates.size(), 2 * kMost);
  for (std::size_t i = kMost; i < 2 * kMost; ++i) ASSERT_EQ(updates[i].serial, serial(i));
  updates.read(10 * kMost);  // not those that are still to come
  EXPECT_EQ(updates.first(), 2 * kMost);
  for (std::size_t i = 0; i < kMost + 1; ++i) updates.add({});
  EXPECT_EQ(updates.lost(), 6U);
}

TEST(ParameterUpdates, ActsFromTheTickThatIsNoted) {
  ebac::Setup setup;
  setup.hand.path[0] = Step{.target = 0.03};
  const Tca law(Tca::Params{.kp = 0});
  auto loop = simulated_loop(setup, PerAxis<Tca>(law));
  const auto trace = loop.make_trace(600);
  ParameterUpdates<PerAxis<Tca>> updates(law);
  const std::uint64_t first = updates.post(Environment(Wall{.stiffness = 100}));
  const std::uint64_t second = updates.post(Tca({.kp = 0, .peak_force = 0.5}));
  const std::uint64_t third = updates.post(HandTarget{.target = {0.02, 0, 0}});
  EXPECT_TRUE(loop.run(*trace, &updates));
  ASSERT_EQ(updates.applied().size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(updates.applied()[i].tick, 0);
  EXPECT_EQ(updates.applied()[0].serial, second);
  EXPECT_EQ(updates.applied()[1].serial, first);
  EXPECT_EQ(updates.applied()[2].serial, third);
  double most = 0;
  double furthest = 0;
  for (std::size_t row = 0; row < trace->size(); ++row) {
    const Port port = trace->sample(row).axis[0].port;
    most = std::max(most, port.f_cmd);
    furthest = std::max(furthest, port.f_env / 100);
  }
  EXPECT_EQ(most, 0.5);
  EXPECT_GT(furthest, 0.018);  // towards 20 mm, overshoot added, not the 30 mm of the start
  EXPECT_LT(furthest, 0.028);
}

TEST(ParameterUpdates, ALawKeepsItsMemoryWhenItsGainsChange) {
  Port port{.dx = 1e-5, .v = 0.01, .dt = 1e-3, .f_env = 1};
  Tca law(Tca::Params{.kp = 0, .kd = 0.01});
  for (int i = 0; i < 50; ++i) law.step(port);
  port.f_env = 2;
  Tca same = law;
  same.retune(Tca(law.params()));
  EXPECT_EQ(law.step(port), same.step(port));
  Tca fresh{law.params()};
  EXPECT_NE(law.step(port), fresh.step(port));
}

}  // namespace
}  // namespace ebac::parameter_updates_test
