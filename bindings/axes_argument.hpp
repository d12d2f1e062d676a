#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "ebac/model/kinematics.hpp"

namespace ebac::python {

/// A point or a force with as many entries as the device has axes.
inline Axes as_axes(const std::vector<double>& values, int axes, const char* what) {
  if (values.size() != static_cast<std::size_t>(axes)) {
    throw std::invalid_argument(std::string(what) + " has " + std::to_string(values.size()) +
                                " values: must have " + std::to_string(axes) +
                                ", one for each axis");
  }
  Axes all = Axes::Zero();
  for (std::size_t i = 0; i < values.size(); ++i) all[static_cast<Eigen::Index>(i)] = values[i];
  return all;
}

}  // namespace ebac::python
