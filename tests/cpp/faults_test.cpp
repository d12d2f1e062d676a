// Whatever goes wrong, at whatever moment: the command is zero at once, the drives are off, the
// fault has its right name, nothing starts again by itself.
#include <gtest/gtest.h>

#include "ebac/faults/case.hpp"

namespace ebac::faults {
namespace {

class EveryKind : public testing::TestWithParam<std::size_t> {};

TEST_P(EveryKind, EndsAsItShould) {
  for (std::uint64_t i = 0; i < 30; ++i) {
    const Trouble trouble = trouble_of(/*seed=*/7, i * kKinds + GetParam());
    const Result result = run_case(trouble);
    EXPECT_EQ(static_cast<int>(result.verdict), 0)
        << facts_of(trouble.kind).name << " for " << trouble.ticks << " ticks from " << trouble.at
        << " on axis " << trouble.axis << ", chance " << trouble.chance << ": fault "
        << static_cast<unsigned>(result.fault) << ", detected after " << result.detected
        << ", zero after " << result.to_zero << ", off after " << result.to_off;
  }
}

TEST_P(EveryKind, GivesTheSameAgain) {
  const Trouble trouble = trouble_of(/*seed=*/3, kKinds + GetParam());
  const Result one = run_case(trouble);
  const Result two = run_case(trouble);
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
}  // namespace ebac::faults
