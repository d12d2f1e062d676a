#include "ebac/model/device.hpp"

#include <sstream>
#include <stdexcept>

namespace ebac {

void check_device(const DeviceModel& device) {
  const Mechanics& mechanics = device.mechanics;
  std::ostringstream why;
  if (mechanics.backlash > 0 && !mechanics.compliant()) {
    why << "Mechanics.backlash = " << mechanics.backlash
        << " m: needs a cable_stiffness above 0 N/m to act on; set one, or backlash = 0 m";
  } else if (device.compensation.inertia > 0.5 * device.mass()) {
    why << "Compensation.inertia = " << device.compensation.inertia << " kg: must lie in [0, "
        << 0.5 * device.mass() << "] kg, half of the device's mass";
  }
  if (const std::string text = why.str(); !text.empty()) throw std::invalid_argument(text);
}

}  // namespace ebac
