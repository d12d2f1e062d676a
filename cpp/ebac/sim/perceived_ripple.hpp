#pragma once

#include <cstddef>
#include <span>

#include "ebac/core/fields.hpp"

/// What a hand feels of a force that trembles: its vibration, weighed by how well it is detected.
namespace ebac {

inline constexpr double kVibrationFrom = 20;    // Hz; slower than this a force moves, not vibrates
inline constexpr double kFewestVibrating = 80;  // Hz; fewer rows a second show no vibration

/// Amplitude of a sine of the applied force between 20 and 160 Hz that is just detected [N].
///
/// Israr, Choi, Tan, "Detection threshold and mechanical impedance of the hand in a pen-hold
/// posture", IROS 2006, 472-477: detected amplitudes d of a held stylus are 26 um at 10 Hz, 8.5 um
/// at 20 Hz, 13 dB less with each octave to 160 Hz, and 0.06 um at 320 Hz, the least; the impedance
/// Z of the hand is 12.6 to 15.8 N s/m below 40 Hz, 7 dB less at 80 Hz, 16 dB less again at 160 Hz
/// and the same at 320 Hz. Assumed here: the force moves a handle of M = 0.25 kg (the reference
/// device) in such a hand, so |j w M + Z| w d is just detected: 37, 31, 27, 24 and 61 mN at 20, 40,
/// 80, 160 and 320 Hz. 25 mN behind the filters below is within 2 dB of that.
inline constexpr double kDetected = 25e-3;
inline constexpr double kPerceivedBelow = 200;    // Hz, corner of the low-pass
inline constexpr double kPerceivedDamping = 0.5;  // 1, of the low-pass
inline constexpr double kPerceivedOver = 0.2;     // s, over which vibration sums up (Verrillo 1965)

/// The vibration of a force in numbers; NaN where there are fewer than 80 rows a second.
struct PerceivedRipple {
  double high;       // N
  double perceived;  // 1
};

/// Filters all of a force of `rate` rows a second [Hz], as after a long rest on its first row, and
/// counts from row `from` on: until then the filter rings down from an impact.
///
/// high: root mean square of y, the force behind a Butterworth high-pass of
/// second order at 20 Hz (bilinear transform, corner kept).
///
/// perceived: largest vibration at any time, in detection thresholds,
/// sqrt(2 m) / 25 mN. m is the square of y behind a low-pass of second order (200 Hz, no higher
/// than 0.4 of the rate; damping 0.5; poles mapped by exp(s T)), averaged with exponential weight
/// over 0.2 s, from zero at `from`. A sine that lasts comes to its amplitude over the one
/// that is just detected.
PerceivedRipple perceived_ripple(std::span<const double> force, double rate, std::size_t from);

}  // namespace ebac
