// One drive as a loop sees it: a flood of answers that it cannot have sent.
#include "ebac/canopen/node_link.hpp"

#include <gtest/gtest.h>

namespace ebac::can::node_link_test {
namespace {

/// What is counted of it has an end: else the number would overflow, and the drive be suspect for hours.
TEST(NodeLink, AFloodOfAnswersIsNotedAndForgotten) {
  NodeLink link(1);
  Frame answer{.id = tpdo(1, 1), .size = kTpdoSize};
  link.open(1e-3);
  link.sync();
  for (int i = 0; i < 100'000; ++i) {
    put(answer.data, 2, i);
    link.take(answer);
  }
  link.close();
  EXPECT_TRUE(link.duplicated());
  for (int tick = 0; tick < 1000; ++tick) {
    link.open(1e-3);
    link.sync();
    link.take(answer);
    link.close();
  }
  EXPECT_FALSE(link.duplicated());
}

}  // namespace
}  // namespace ebac::can::node_link_test
