#pragma once

#include <array>
#include <cstdint>

#include "ebac/core/fields.hpp"

namespace ebac::sensor {

/// Columns of a trace for the force sensor, per axis; the counts are those of the whole sensor.
struct RdtRow {
  double torque = 0;  // N m
  double age = 0;     // s
  std::int64_t status = 0;
  std::int64_t received = 0;
  std::int64_t lost = 0;
  std::int64_t late = 0;
  std::int64_t duplicate = 0;
  std::int64_t malformed = 0;
  std::int64_t foreign = 0;

  static constexpr auto fields() {
    using F = Field<RdtRow>;
    return std::array{
        F{"torque", &RdtRow::torque, "N m", "torque the sensor measures about the handle's axis"},
        F{"age", &RdtRow::age, "s", "time since the newest record came"},
        F{"status", &RdtRow::status, "1", "status bits of the newest record; 0 when all is well"},
        F{"received", &RdtRow::received, "1", "records used, from the start on"},
        F{"lost", &RdtRow::lost, "1", "records that did not come"},
        F{"late", &RdtRow::late, "1", "records that came after a newer one; not used"},
        F{"duplicate", &RdtRow::duplicate, "1", "records that came again; not used"},
        F{"malformed", &RdtRow::malformed, "1",
          "packets of the sensor that are no record: too short, too long, or out of all order"},
        F{"foreign", &RdtRow::foreign, "1", "packets of somebody else"},
    };
  }
};

}  // namespace ebac::sensor
