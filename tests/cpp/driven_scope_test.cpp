// The scope behind simulated drives: how long it moves after a pause of its drives.
#include "ebac/gastroscope/driven_scope.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace ebac::gastroscope::driven_scope_test {
namespace {

TEST(DrivenScope, MakesUpForNoPauseOfItsDrives) {
  DrivenScope scope({}, std::make_shared<const Lumen>(PatientParams{}), 0.09, {});
  scope.meet(0, {}, 2e-3);
  EXPECT_DOUBLE_EQ(scope.report().seconds, 2e-3);
  scope.meet(0, {}, 5);
  EXPECT_GT(scope.report().seconds, 0.01);
  EXPECT_LE(scope.report().seconds, 0.25);
}

}  // namespace
}  // namespace ebac::gastroscope::driven_scope_test
