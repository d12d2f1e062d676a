#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "ebac/model/motor.hpp"

namespace ebac::can {

/// Amperes and whole thousandths of the rated torque, as 0x6071 and 0x6077 carry them: eq. (1).
struct TorqueScale {
  double one = 1e-3;   // A, of a thousandth of the rated torque
  double peak = 1;     // A, largest ever asked for
  double most = 1000;  // thousandths: the peak, and what 16 bits hold

  static TorqueScale of(const Motor& motor, const Drive& drive) EBAC_RT {
    TorqueScale scale{.one = motor.current(motor.rated_torque) / 1000,
                      .peak = drive.peak_current(motor)};
    scale.most = std::min(std::round(scale.peak / scale.one), 32767.0);
    return scale;
  }

  /// Rounded to the nearest thousandth, held within the limits; no number asks for nothing.
  std::int16_t permille(double current) const EBAC_RT {
    if (std::isnan(current)) return 0;
    const double whole = std::round(std::clamp(current, -peak, peak) / one);
    return static_cast<std::int16_t>(std::clamp(whole, -most, most));
  }
  double current(std::int16_t torque_permille) const EBAC_RT { return one * torque_permille; }
};

}  // namespace ebac::can
