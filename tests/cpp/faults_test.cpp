// Whatever goes wrong, at whatever moment: the command is zero at once, the drives are off, the
// fault has its right name, nothing starts again by itself.
#include <gtest/gtest.h>

#include "ebac/faults/case.hpp"
#include "rounds.hpp"

namespace ebac::faults::faults_test {
namespace {

class EveryKind : public testing::TestWithParam<std::size_t> {};

TEST_P(EveryKind, EndsAsItShould) {
  constexpr std::uint64_t kCases = rounds(30);
  for (std::uint64_t i = 0; i < kCases; ++i) {
    const InjectedFault injected = injected_fault_of(/*seed=*/7, i * kKinds + GetParam());
    const Result result = run_case(injected);
    EXPECT_EQ(static_cast<int>(result.verdict), 0)
        << facts_of(injected.kind).name << " for " << injected.ticks << " ticks from "
        << injected.at << " on axis " << injected.axis << ", chance " << injected.chance
        << ": fault " << static_cast<unsigned>(result.fault) << ", detected after "
        << result.detected << ", zero after " << result.to_zero << ", off after " << result.to_off
        << ", " << kRuleFacts[static_cast<std::size_t>(result.breach.rule)].name << " "
        << result.breach.value << " against " << result.breach.bound << " on axis "
        << result.breach.axis << " in tick " << result.breach.tick;
  }
}

TEST_P(EveryKind, GivesTheSameAgain) {
  const InjectedFault injected = injected_fault_of(/*seed=*/3, kKinds + GetParam());
  const Result one = run_case(injected);
  const Result two = run_case(injected);
  EXPECT_EQ(one.verdict, two.verdict);
  EXPECT_EQ(one.fault, two.fault);
  EXPECT_EQ(one.detected, two.detected);
  EXPECT_EQ(one.to_zero, two.to_zero);
  EXPECT_EQ(one.to_off, two.to_off);
}

INSTANTIATE_TEST_SUITE_P(, EveryKind, testing::Range<std::size_t>(0, kKinds),
                         [](const auto& param) {
                           return std::string(kKindFacts[param.param].name);
                         });

}  // namespace
}  // namespace ebac::faults::faults_test
