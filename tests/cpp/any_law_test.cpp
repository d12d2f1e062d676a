#include "ebac/sim/any_law.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <tuple>

#include "ebac/control/law_type.hpp"
#include "ebac/control/law_types.hpp"
#include "ebac/control/laws.hpp"
#include "ebac/loop/retune.hpp"
#include "ebac/sim/simulate.hpp"

namespace ebac {
namespace {

Setup short_run() {
  Setup setup;
  setup.seconds = 0.3;
  return setup;
}

/// The samples of two traces, byte by byte: Sample has no padding between its fields.
bool same_samples(const Trace& one, const Trace& other) {
  if (one.size() != other.size() || one.row_bytes() != other.row_bytes()) return false;
  for (std::size_t i = 0; i < one.size(); ++i) {
    const Sample a = one.sample(i);
    const Sample b = other.sample(i);
    if (std::memcmp(&a, &b, sizeof(Sample)) != 0) return false;
  }
  return true;
}

template <class Law>
void expect_same_run() {
  const ebac::Setup setup = short_run();
  const Law law(Law::Params::design(setup.device.facts(), setup.timing), setup.timing);
  const auto typed = simulate(setup, law);
  const auto any = simulate_any(setup, any_law(law));
  EXPECT_TRUE(same_samples(*typed, *any)) << Law::kName;
  ASSERT_EQ(typed->columns().size(), any->columns().size());
  for (std::size_t i = 0; i < typed->columns().size(); ++i) {
    EXPECT_EQ(typed->columns()[i].name, any->columns()[i].name);
    EXPECT_EQ(typed->columns()[i].offset, any->columns()[i].offset);
  }
}

template <class... Law>
void expect_same_runs(const std::tuple<Law...>*) {
  (expect_same_run<Law>(), ...);
}

/// One without state, one with, and the one that has a loop of its own. A loop more is ten seconds of compiler.
using Kinds = std::tuple<Direct, PassivityControl, Ebac>;
TEST(AnyLaw, RunsAsTheLawItself) { expect_same_runs(static_cast<const Kinds*>(nullptr)); }

TEST(AnyLaw, IsDesignedAndMadeByItsType) {
  const ebac::Setup setup = short_run();
  const LawType& type = law_named("ebac");
  EbacParams params;
  type.design(&params, setup.device.facts(), setup.timing);
  const AnyLaw law = type.make(&params, setup.timing);
  const FieldRow* damping = type.params.find("damping");
  ASSERT_NE(damping, nullptr);
  EXPECT_EQ(damping->number(law.params()), setup.device.facts().damping);
  EXPECT_EQ(law_types().size(), std::tuple_size_v<Laws>);
  EXPECT_THROW(law_named("none"), std::invalid_argument);
  params.damping = -1;
  EXPECT_THROW(type.make(&params, setup.timing), std::invalid_argument);
}

TEST(AnyLaw, IsAValue) {
  AnyLaw law = any_law(Ebac({}));
  const AnyLaw fresh = law;
  Port port{.x = 1e-4, .dx = 1e-4, .dt = 1e-3, .f_env = 1};
  static_cast<void>(law.step(port));
  static_cast<void>(law.step(port));
  AnyLaw copy = law;
  EXPECT_EQ(copy.step(port), law.step(port));
  EXPECT_NE(std::memcmp(fresh.state(), law.state(), law.state_table().size), 0);
  law = fresh;
  EXPECT_EQ(law.state_table().find("energy")->number(law.state()), EbacParams{}.reserve);
}

TEST(AnyLaw, IsRetunedByItsOwnTypeOnly) {
  AnyLaw law = any_law(Ebac({}));
  const AnyLaw softer = any_law(Ebac({.kp = 0.2}));
  EXPECT_NO_THROW(check_retune(law, softer));
  law.retune(softer);
  EXPECT_EQ(law.type().params.find("kp")->number(law.params()), 0.2);
  EXPECT_THROW(check_retune(law, any_law(Ebac({.mass = 0.3}))), std::invalid_argument);
  EXPECT_THROW(check_retune(law, any_law(Direct({}))), std::invalid_argument);
}

TEST(AnyLaw, OfOtherDeviceFactsTakesOverAnew) {
  const AnyLaw law = any_law(Ebac({}));
  EXPECT_TRUE(law.same_but_gains(any_law(Ebac({.kp = 0.2}))));
  EXPECT_FALSE(law.same_but_gains(any_law(Ebac({.mass = 0.3}))));
  EXPECT_FALSE(law.same_but_gains(any_law(Ebac({}, {.delay = 2}))));
  EXPECT_FALSE(law.same_but_gains(any_law(Direct({}))));

  PerAxis<AnyLaw> laws(any_law(Ebac({.reserve = 0.01})));
  auto next = PerAxis<AnyLaw>::replacement(any_law(Ebac({.reserve = 0.03})));
  laws.adopt(next);
  EXPECT_EQ(laws.state_table().find("energy")->number(laws.state(0)), 0.03);
}

/// A law whose gains are fixed.
class Fixed : public Direct {
 public:
  static constexpr std::string_view kName = "fixed";
  using Direct::Direct;
  void retune(const Fixed&) = delete;
};

TEST(AnyLaw, WithoutRetuneTakesOverAnewAndIsNotRetuned) {
  const AnyLaw law = any_law(Fixed(Direct::Params{}));
  EXPECT_FALSE(law.type().tunable);
  EXPECT_FALSE(law.same_but_gains(law));
  try {
    check_retune(law, law);
    FAIL() << "it was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string_view(error.what()).find("fixed"), std::string_view::npos);
  }
}

}  // namespace
}  // namespace ebac
