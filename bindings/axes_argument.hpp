#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "ebac/model/kinematics.hpp"

namespace ebac::python {

/// Refuses a list that is not one value for each axis.
inline void check_axes(const std::string& name, std::size_t given, int axes) {
  if (given == static_cast<std::size_t>(axes)) return;
  throw std::invalid_argument(name + " has " + std::to_string(given) +
                              (given == 1 ? " value" : " values") + ": must have " +
                              std::to_string(axes) + ", one for each axis");
}

/// A point or a force with as many entries as the device has axes.
inline Axes as_axes(const std::vector<double>& values, int axes, const char* what) {
  check_axes(what, values.size(), axes);
  Axes all = Axes::Zero();
  for (std::size_t i = 0; i < values.size(); ++i) all[static_cast<Eigen::Index>(i)] = values[i];
  return all;
}

}  // namespace ebac::python
