#pragma once

#include <array>
#include <string_view>

#include "ebac/sim/setup.hpp"

namespace ebac::wasm {

/// A part of a setup whose numbers may be set by name: "hand.mass", "environment.stiffness". The
/// prefixes are those of a scenario's TOML file.
struct Part {
  std::string_view prefix;
  const FieldTable* table;
  void* owner;
};

/// The parts of a setup: a device of one straight axis, a wall, a hand that steps to a target.
inline std::array<Part, 12> parts_of(Setup& setup) {
  const auto part = [](std::string_view prefix, auto& owner) {
    return Part{prefix, &field_table<std::remove_reference_t<decltype(owner)>>(), &owner};
  };
  DeviceModel& device = setup.device;
  return {part("device.kinematics", std::get<Linear>(device.kinematics)),
          part("device.motor", device.motor),
          part("device.drive", device.drive),
          part("device.encoder", device.encoder),
          part("device.capstan", device.capstan),
          part("device.mechanics", device.mechanics),
          part("device.sensor", device.sensor),
          part("device.compensation", device.compensation),
          part("hand.path", std::get<Step>(setup.hand.path[0])),
          part("hand", setup.hand),
          part("environment", std::get<Wall>(setup.environment)),
          part("timing", setup.timing)};
}

/// Sets one number. Throws std::invalid_argument for a name that is none, or a value out of range.
void set(Setup& setup, std::string_view name, double value);

}  // namespace ebac::wasm
