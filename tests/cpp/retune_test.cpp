// What a law's parameters may become while it runs, for every law.
#include "ebac/loop/retune.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "ebac/control/fixed_params.hpp"
#include "ebac/control/laws.hpp"
#include "ebac/loop/parameter_updates.hpp"
#include "ebac/sim/simulate.hpp"

namespace ebac::retune_test {
namespace {

template <class... Law>
constexpr bool all_tunable(std::tuple<Law...>*) {
  return (Tunable<Law> && ...) && (std::is_trivially_copyable_v<Law> && ...);
}
static_assert(all_tunable(static_cast<Laws*>(nullptr)));

TEST(Retune, TellsWhatMayNotChange) {
  const Ebac now(Ebac::Params{});
  EXPECT_NO_THROW(check_retune(now, Ebac({.kp = 0.2})));
  try {
    check_retune(now, Ebac({.mass = 0.3}));
    FAIL() << "the mass changed";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "ebac.mass = 0.3 kg: cannot change from 0.25 while the loop runs; stop it first");
  }
  EXPECT_THROW(check_retune(now, Ebac({}, {.delay = 2})), std::invalid_argument);
  EXPECT_THROW(check_retune(now, Ebac({.reserve = 0.02})), std::invalid_argument);
  EXPECT_THROW(check_retune(now, Ebac({.observed_reserve = 0.02})), std::invalid_argument);
  EXPECT_THROW(check_retune(now, Ebac({.force_noise = 0.3})), std::invalid_argument);
}

/// What may change changes as a whole: before its first tick, a law that was retuned is as if it had been made so.
template <class Law>
void expect_each_gain_is_taken() {
  Setup setup{.seconds = 1.5};
  setup.observer = ObserverParams::of(setup.device, setup.timing);
  const FieldTable& table = field_table<typename Law::Params>();
  for (const FieldRow& field : table.rows) {
    if (std::ranges::find(kFixedParams, field.name) != kFixedParams.end()) continue;
    const Law before(Law::Params::design(setup.device.facts(), setup.timing), setup.timing);
    typename Law::Params params = before.params();
    if (field.kind == FieldKind::kBool) {
      field.in<bool>(&params) = !field.in<bool>(&params);
    } else {
      auto& value = field.in<double>(&params);
      value = value > field.low ? 0.5 * (value + field.low) : std::min(1.0, field.high);
    }
    const Law made(params, setup.timing);
    Law retuned = before;
    retuned.retune(made);
    const auto expected = simulate(setup, made);
    const auto found = simulate(setup, retuned);
    ASSERT_EQ(found->size(), expected->size());
    for (std::size_t row = 0; row < found->size(); ++row) {
      ASSERT_EQ(found->sample(row).axis[0].port.f_cmd, expected->sample(row).axis[0].port.f_cmd)
          << Law::kName << "." << field.name << ", row " << row;
    }
  }
}

TEST(Retune, TakesEachGain) {
  [&]<class... Law>(std::tuple<Law...>*) {
    (expect_each_gain_is_taken<Law>(), ...);
  }(static_cast<Laws*>(nullptr));
}

/// Retuned to what it is, a law goes on as if nothing had happened.
template <class Law>
void expect_same_after_retune() {
  const ebac::Setup setup;
  const Law law(Law::Params::design(setup.device.facts(), setup.timing), setup.timing);
  const auto plain = simulate(setup, law);
  auto loop = simulated_loop(setup, PerAxis<Law>(law));
  const auto trace = loop.make_trace(row_count(setup));
  ParameterUpdates<PerAxis<Law>> updates(law);
  updates.post(law);
  loop.run(*trace, &updates);
  ASSERT_EQ(updates.applied().size(), 1U);
  ASSERT_EQ(trace->size(), plain->size());
  for (std::size_t row = 0; row < trace->size(); ++row) {
    ASSERT_EQ(trace->sample(row).axis[0].port.f_cmd, plain->sample(row).axis[0].port.f_cmd)
        << Law::kName << ", row " << row;
  }
}

TEST(Retune, ToTheSameChangesNothing) {
  [&]<class... Law>(std::tuple<Law...>*) {
    (expect_same_after_retune<Law>(), ...);
  }(static_cast<Laws*>(nullptr));
}

}  // namespace
}  // namespace ebac::retune_test
