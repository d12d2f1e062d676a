#pragma once

#include <array>
#include <cstdint>

#include "ebac/core/fields.hpp"
#include "ebac/core/realtime.hpp"

namespace ebac::sensor {

/// How an emulated sensor is built.
struct EmulatorOptions {
  double rate = 1000;              // Hz
  double counts_per_force = 1e6;   // 1/N
  double counts_per_torque = 1e6;  // 1/(N m)
  double force_range = 145;        // N
  double torque_range = 5;         // N m
  double lever = 0.02;             // m
  double load = 0;                 // N
  int buffer = 10;                 // records

  static constexpr auto fields() {
    using F = Field<EmulatorOptions>;
    return std::array{
        F{"rate", &EmulatorOptions::rate, "Hz", "records a second", 1, 7000},
        F{"counts_per_force", &EmulatorOptions::counts_per_force, "1/N", "counts of one newton",
          1e-3, 1e7},
        F{"counts_per_torque", &EmulatorOptions::counts_per_torque, "1/(N m)",
          "counts of one newton metre", 1e-3, 1e8},
        F{"force_range", &EmulatorOptions::force_range, "N",
          "largest force along an axis; it saturates", 1e-3, 1e5},
        F{"torque_range", &EmulatorOptions::torque_range, "N m", "largest torque about an axis",
          1e-3, 1e5},
        F{"lever", &EmulatorOptions::lever, "m",
          "from the sensor to where the hand holds, along its z axis", -1, 1},
        F{"load", &EmulatorOptions::load, "N",
          "what weighs on its z axis besides the hand, until a bias", -1e4, 1e4},
        F{"buffer", &EmulatorOptions::buffer, "1", "records in a packet of a buffered stream", 1,
          40},
    };
  }
};

/// Errors of an emulated sensor.
struct EmulatorTrouble {
  double loss = 0;
  double duplicate = 0;
  double reorder = 0;
  bool silent = false;
  std::int64_t status = 0;

  static constexpr auto fields() {
    using F = Field<EmulatorTrouble>;
    return std::array{
        F{"loss", &EmulatorTrouble::loss, "1", "share of the packets that are not sent", 0, 1},
        F{"duplicate", &EmulatorTrouble::duplicate, "1", "share that is sent twice", 0, 1},
        F{"reorder", &EmulatorTrouble::reorder, "1", "share that is sent after the next one", 0, 1},
        F{"silent", &EmulatorTrouble::silent, "1", "whether nothing at all is sent", 0, 1},
        F{"status", &EmulatorTrouble::status, "1", "bits set in every record", 0, 4294967295.0},
    };
  }
};

/// Counts of an emulated sensor.
struct EmulatorCounts {
  std::int64_t requests = 0;
  std::int64_t refused = 0;
  std::int64_t sent = 0;
  std::int64_t dropped = 0;
  std::int64_t doubled = 0;
  std::int64_t swapped = 0;

  static constexpr auto fields() {
    using F = Field<EmulatorCounts>;
    return std::array{
        F{"requests", &EmulatorCounts::requests, "1", "requests obeyed"},
        F{"refused", &EmulatorCounts::refused, "1", "packets that are no request it knows"},
        F{"sent", &EmulatorCounts::sent, "1", "packets sent, doubles included"},
        F{"dropped", &EmulatorCounts::dropped, "1", "packets lost on purpose, or while silent"},
        F{"doubled", &EmulatorCounts::doubled, "1", "packets sent twice"},
        F{"swapped", &EmulatorCounts::swapped, "1", "packets sent after the next one"},
    };
  }
};

}  // namespace ebac::sensor
