#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "ebac/canopen/cia402.hpp"
#include "ebac/canopen/cob_id.hpp"
#include "ebac/model/motor.hpp"

namespace ebac::can {

/// Amperes and whole thousandths of the rated torque, as 0x6071 and 0x6077 carry them: eq. (1).
struct TorqueScale {
  double one = 1e-3;   // A, of a thousandth of the rated torque
  double peak = 1;     // A, largest command
  double most = 1000;  // thousandths: the peak, within 16 bits

  static TorqueScale of(const Motor& motor, const Drive& drive) EBAC_RT {
    TorqueScale scale{.one = motor.current(motor.rated_torque) / 1000,
                      .peak = drive.peak_current(motor)};
    scale.most = std::min(std::round(scale.peak / scale.one), 32767.0);
    return scale;
  }

  /// Rounded to the nearest thousandth, held within the limits; NaN gives 0.
  std::int16_t permille(double current) const EBAC_RT {
    if (std::isnan(current)) return 0;
    const double whole = std::round(std::clamp(current, -peak, peak) / one);
    return static_cast<std::int16_t>(std::clamp(whole, -most, most));
  }
  double current(std::int16_t torque_permille) const EBAC_RT { return one * torque_permille; }
};

/// A number written into the object dictionary of a drive.
struct ObjectWrite {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  std::int64_t value = 0;
};

/// Writes that make a drive follow a torque at every SYNC and answer each with the data of
/// `pdo_plan`, in the required order (CiA 301, 7.5.2.36). `most`: largest torque, in thousandths of
/// the rated torque.
constexpr std::array<ObjectWrite, 18> torque_settings(NodeId node, int most) EBAC_RT {
  constexpr std::int64_t kEverySync = 1;
  constexpr std::int64_t kNoCurrentLimit = 0xFFFF;
  return {{
      {0x6060, 0, kCyclicTorque},
      {0x6072, 0, most},
      {0x6073, 0, kNoCurrentLimit},  // the torque is limited, not both
      {0x1400, 1, kInvalid | rpdo(1, node)},
      {0x1400, 2, kEverySync},
      {0x1600, 0, 0},
      {0x1600, 1, 0x60400010},  // controlword
      {0x1600, 2, 0x60710010},  // target torque
      {0x1600, 0, 2},
      {0x1400, 1, rpdo(1, node)},
      {0x1800, 1, kInvalid | kNoRemote | tpdo(1, node)},
      {0x1800, 2, kEverySync},
      {0x1A00, 0, 0},
      {0x1A00, 1, 0x60410010},  // statusword
      {0x1A00, 2, 0x60640020},  // position
      {0x1A00, 3, 0x60770010},  // actual torque
      {0x1A00, 0, 3},
      {0x1800, 1, kNoRemote | tpdo(1, node)},
  }};
}

}  // namespace ebac::can
