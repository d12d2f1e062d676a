#include "ebac/canopen/canopen_setup.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "ebac/canopen/pdo_plan.hpp"
#include "ebac/core/check.hpp"

namespace ebac::can {

namespace {

void check_sign(const char* name, int sign) {
  if (sign == 1 || sign == -1) return;
  throw std::invalid_argument("CanopenSetup." + std::string(name) + " = " + std::to_string(sign) +
                              ": must be 1 or -1");
}

}  // namespace

void check_setup(const CanopenSetup& setup) {
  check(setup, "CanopenSetup");
  check(setup.motor, "Motor");
  check(setup.drive, "Drive");
  for (const int sign : setup.motor_sign) check_sign("motor_sign", sign);
  for (const int sign : setup.encoder_sign) check_sign("encoder_sign", sign);
  const std::vector<int> nodes(setup.node.begin(), setup.node.begin() + setup.axes);
  static_cast<void>(pdo_plan(nodes));
  if (std::ranges::find(nodes, setup.own_node) != nodes.end()) {
    throw std::invalid_argument("CanopenSetup.own_node = " + std::to_string(setup.own_node) +
                                ": is the node of a drive, whose heartbeat others would take for "
                                "the loop's; choose another");
  }
}

}  // namespace ebac::can
