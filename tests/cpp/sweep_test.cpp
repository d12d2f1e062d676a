// Many runs at once: the numbers of single runs, whatever the number of threads.
#include "ebac/sim/sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <thread>

#include "designed_law.hpp"
#include "ebac/control/law_type.hpp"
#include "ebac/sim/any_law.hpp"

namespace ebac::sweep_test {
namespace {

struct Tasks {
  std::vector<Setup> setups;

  std::vector<const Setup*> pointers() const {
    std::vector<const Setup*> all;
    all.reserve(setups.size());
    for (const Setup& setup : setups) all.push_back(&setup);
    return all;
  }
};

Tasks noisy_hands(int count) {
  Tasks tasks;
  for (int i = 0; i < count; ++i) {
    Setup setup{.hand = {.mass = 0.05 + 0.02 * i, .stiffness = 100.0 + 30 * i},
                .seconds = 0.5,
                .jitter = 0.2,
                .seed = static_cast<std::uint64_t>(i)};
    setup.device.sensor.noise = 0.1;
    tasks.setups.push_back(setup);
  }
  return tasks;
}

std::vector<Outcome> run(const Tasks& tasks, const AnyLaw& law, int threads,
                         SweepProgress& progress) {
  const std::vector<const AnyLaw*> laws(tasks.setups.size(), &law);
  return sweep_any(tasks.pointers(), laws, threads, RunLimits{}, progress);
}

std::vector<Outcome> run(const Tasks& tasks, const AnyLaw& law, int threads) {
  SweepProgress progress;
  return run(tasks, law, threads, progress);
}

bool same_bits(const WallContact& a, const WallContact& b) {
  return std::ranges::all_of(WallContact::fields(), [&](const auto& field) {
    const auto bits = [&](const WallContact& of) {
      return std::bit_cast<std::uint64_t>(*static_cast<const double*>(field.member.in(of)));
    };
    return bits(a) == bits(b);
  });
}

/// A column of doubles of a trace, first axis.
std::vector<double> column(const Trace& trace, std::string_view name) {
  std::vector<double> values(trace.size());
  for (const Column& c : trace.columns()) {
    if (c.name != name) continue;
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::memcpy(&values[i], trace.data() + i * trace.row_bytes() + c.offset, sizeof(double));
    }
  }
  return values;
}

/// The law of a test: pushes with a constant force, or answers no number.
class Pusher {
 public:
  static constexpr std::string_view kName = "pusher";
  static constexpr std::string_view kSummary = "pushes";
  static constexpr bool kPassive = false;
  struct Params {
    double force = -40;  // N
    static Params design(const DeviceFacts&, Timing) { return {}; }
    static constexpr auto fields() { return std::array<Field<Params>, 0>{}; }
  };
  struct State {
    static constexpr auto fields() { return std::array<Field<State>, 0>{}; }
  };
  explicit Pusher(const Params& params, Timing timing = {}) : params_(params), timing_(timing) {}
  double step(const Port&) EBAC_RT { return params_.force; }
  void reset() EBAC_RT {}
  const State& state() const EBAC_RT { return state_; }
  const Params& params() const EBAC_RT { return params_; }
  const Timing& timing() const EBAC_RT { return timing_; }

 private:
  Params params_;
  Timing timing_;
  State state_{};
};

TEST(Sweep, MeasuresWhatSimulateWrites) {
  const Tasks tasks = noisy_hands(5);
  const AnyLaw law = designed_law("ebac");
  const std::vector<Outcome> outcomes = run(tasks, law, 2);
  for (std::size_t i = 0; i < tasks.setups.size(); ++i) {
    const auto trace = simulate_any(tasks.setups[i], law);
    EXPECT_EQ(outcomes[i].ticks, trace->size());
    EXPECT_TRUE(outcomes[i].done);
    const auto t = column(*trace, "t");
    const auto x = column(*trace, "true.x");
    const auto force = column(*trace, "f_applied");
    const auto energy = column(*trace, "true.energy");
    std::vector<double> stored;
    stored.reserve(x.size());
    for (const double at : x) stored.push_back(stored_energy(Wall{}, {at, 0, 0}));
    const auto asked = column(*trace, "f_env");
    const auto command = column(*trace, "f_cmd");
    std::vector<double> pull(x.size());
    for (std::size_t j = 0; j < x.size(); ++j) {
      const bool acts = asked[j] != 0 || command[j] != 0 || force[j] != 0;
      if (acts) pull[j] = tasks.setups[i].hand.pull(0, t[j], x[j]);
    }
    WallContact expected = measure_contact({.t = t,
                                            .x = x,
                                            .force = force,
                                            .energy = energy,
                                            .stored = stored,
                                            .pull = pull,
                                            .wall = asked});
    expected.clamped_share = outcomes[i].contact.clamped_share;
    EXPECT_GT(expected.clamped_share, 0);
    EXPECT_TRUE(same_bits(outcomes[i].contact, expected));
  }
}

TEST(Sweep, GivesTheSameBitsWithAnyNumberOfThreads) {
  const Tasks tasks = noisy_hands(23);
  const AnyLaw law = designed_law("tca");
  const std::vector<Outcome> one = run(tasks, law, 1);
  for (const int threads : {2, 7, 0}) {
    const std::vector<Outcome> more = run(tasks, law, threads);
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_TRUE(same_bits(one[i].contact, more[i].contact)) << i << " with " << threads;
    }
  }
}

TEST(Sweep, EndsARunThatDiverges) {
  Tasks tasks;
  tasks.setups.push_back({.hand = {.mass = 0, .damping = 0, .stiffness = 0}});
  const Outcome outcome = run(tasks, any_law(Pusher({})), 1).front();
  EXPECT_TRUE(outcome.diverged);
  EXPECT_TRUE(outcome.done);
  EXPECT_LT(outcome.ticks, 1000u);
  EXPECT_GT(outcome.contact.peak, 1);
  EXPECT_TRUE(std::isnan(outcome.contact.settled));
}

TEST(Sweep, EndsARunThatFaults) {
  const Tasks tasks = noisy_hands(1);
  const Outcome outcome = run(tasks, any_law(Pusher({.force = std::nan("")})), 1).front();
  EXPECT_EQ(outcome.fault, Fault::kLawNotFinite);
  EXPECT_EQ(outcome.ticks, 1u);
  EXPECT_TRUE(std::isnan(outcome.contact.rest));
}

TEST(Sweep, StopsSoonWhenCancelledAndKeepsWhatIsDone) {
  Tasks tasks = noisy_hands(4);
  tasks.setups[0].seconds = 0.1;
  for (std::size_t i = 1; i < 4; ++i) tasks.setups[i].seconds = 1e4;
  SweepProgress progress;
  std::vector<Outcome> outcomes;
  std::jthread worker([&] { outcomes = run(tasks, designed_law("direct"), 2, progress); });
  while (progress.done == 0) std::this_thread::yield();
  progress.cancelled = true;
  worker.join();
  EXPECT_TRUE(outcomes[0].done);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_FALSE(outcomes[i].done);
}

TEST(Sweep, TellsWhatARunThrows) {
  SweepProgress progress;
  const auto work = [](std::size_t i, ContactRecorder&) {
    if (i == 5) throw std::invalid_argument("task 5");
  };
  EXPECT_THROW(for_each_run(100, 3, progress, work), std::invalid_argument);
}

TEST(Sweep, CountsWhatIsDone) {
  SweepProgress progress;
  run(noisy_hands(9), designed_law("direct"), 3, progress);
  EXPECT_EQ(progress.done, 9u);
  run(Tasks{}, designed_law("direct"), 3, progress);
  EXPECT_EQ(progress.done, 9u);
}

}  // namespace
}  // namespace ebac::sweep_test
