#pragma once

#include <algorithm>
#include <limits>
#include <utility>

#include "ebac/core/device.hpp"
#include "ebac/loop/row_parts.hpp"

namespace ebac::can {

/// A plant whose time stands still while its loop is held up: no exchange lets it move for longer than `longest`. On a
/// machine that is not made for real time the handle does not fall through a wall that nobody computes.
template <Device D>
class PatientPlant {
 public:
  explicit PatientPlant(D plant, double longest = std::numeric_limits<double>::infinity())
      : plant_(std::move(plant)), longest_(longest) {}

  Reading exchange(const Command& command) EBAC_RT {
    Command patient = command;
    patient.elapsed = std::min(command.elapsed, longest_);
    return plant_.exchange(patient);
  }

  auto parts() const EBAC_RT { return row_parts(plant_); }
  const D& device() const EBAC_RT { return plant_; }

 private:
  D plant_;
  double longest_;  // s
};

}  // namespace ebac::can
