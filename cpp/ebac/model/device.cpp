#include "ebac/model/device.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "ebac/core/six_digits.hpp"

namespace ebac {

void check_device(const DeviceModel& device) {
  const Mechanics& mechanics = device.mechanics;
  std::string why;
  if (mechanics.backlash > 0 && !mechanics.compliant()) {
    why = "Mechanics.backlash = " + six_digits(mechanics.backlash) +
          " m: needs a cable_stiffness above 0 N/m to act on; set one, or backlash = 0 m";
  } else if (const auto* slide = std::get_if<SlidingGimbal>(&device.kinematics);
             slide != nullptr && slide->slide_limit > 0.5 * slide->radius) {
    why = "SlidingGimbal.slide_limit = " + six_digits(slide->slide_limit) +
          " m: must lie in [0.0001, " + six_digits(0.5 * slide->radius) +
          "] m, half of the lever radius; shorten the slide or lengthen radius";
  } else if (slide != nullptr && std::abs(std::log2(slide->slide_radius / slide->radius)) > 1) {
    why = "SlidingGimbal.slide_radius = " + six_digits(slide->slide_radius) + " m: must lie in [" +
          six_digits(0.5 * slide->radius) + ", " + six_digits(2 * slide->radius) +
          "] m, half to twice the lever radius: a law has one set of gains for all axes";
  } else if (device.compensation.inertia > 0.5 * device.mass()) {
    why = "Compensation.inertia = " + six_digits(device.compensation.inertia) +
          " kg: must lie in [0, " + six_digits(0.5 * device.mass()) +
          "] kg, half of the device's mass";
  }
  if (!why.empty()) throw std::invalid_argument(why);
}

}  // namespace ebac
