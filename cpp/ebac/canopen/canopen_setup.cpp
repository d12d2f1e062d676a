#include "ebac/canopen/canopen_setup.hpp"

#include "ebac/canopen/pdo_plan.hpp"
#include "ebac/core/check.hpp"

namespace ebac::can {

void check_setup(const CanopenSetup& setup) {
  check(setup, "CanopenSetup");
  check(setup.motor, "Motor");
  check(setup.drive, "Drive");
  const std::vector<int> nodes(setup.node.begin(), setup.node.begin() + setup.axes);
  static_cast<void>(pdo_plan(nodes));
}

}  // namespace ebac::can
