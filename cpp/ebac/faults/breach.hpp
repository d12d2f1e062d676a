#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace ebac::faults {

/// What a referee holds a run against.
enum class Rule : std::uint8_t {
  kNone,
  kPeak,
  kSlew,
  kHeat,
  kSoftStart,
  kNotEnabled,
  kEarlyLaw,
  kOthersOff,
  kSoftWall,
  kDirection,
  kSpeed,
  kWorkspace,
  kHeartbeat,
  kWithheld,
  kStopped,
};
inline constexpr std::size_t kRules = 15;

struct RuleFacts {
  std::string_view name, unit;
};

inline constexpr std::array<RuleFacts, kRules> kRuleFacts{{
    {"none", ""},
    {"current above the peak", "A"},
    {"current changed faster than the slew limit", "A/s"},
    {"heat of the winding", "1"},
    {"current before the soft start let it in", "A"},
    {"current before all drives were enabled", "A"},
    {"law asked before all drives were enabled", "ticks"},
    {"current while another drive is off", "A"},
    {"current inwards over the edge of the workspace, too small", "A"},
    {"current into the virtual wall", "A"},
    {"speed without a stop", "m/s"},
    {"position without a stop", "m"},
    {"time without a heartbeat of the loop, or a request", "s"},
    {"largest current of a law that asks for all force, too small", "A"},
    {"current after the ramp of a stop", "A"},
}};

/// The first rule that a run broke, and by how much.
struct Breach {
  Rule rule = Rule::kNone;
  double value = 0;  // in the unit of the rule
  double bound = 0;
  std::size_t axis = 0;
  std::int64_t tick = 0;
};

}  // namespace ebac::faults
