#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "ebac/core/fields.hpp"
#include "ebac/model/environment.hpp"

/// Metrics of a contact with a wall: the one definition behind `ebac.contact` and every sweep.
namespace ebac {

inline constexpr double kTailShare = 0.3;       // of a run, over which rest and swing are taken
inline constexpr std::size_t kFewestRows = 10;  // fewer have no tail to measure

inline constexpr double kStillSwing = 0.25e-3;  // m, peak to peak; a smaller oscillation is still
inline constexpr double kForceShare = 0.05;     // of its rest: a settled force stays that close,
inline constexpr double kForceBand = 0.2;       // N, or that close, whichever is the wider
inline constexpr double kForceJump = 0.2;       // N; a larger change between two ticks is a jump
inline constexpr std::size_t kRingsDown = 2;    // settling times after which vibration counts,
inline constexpr double kRingsLeast = 0.5;      // s after settling at least
inline constexpr double kQuietPerceived = 3;    // detection thresholds, 10 dB: quiet below

/// A contact in numbers; NaN where a thing does not exist.
///
/// Rests are means over the last 30 % of a run, its tail. What is measured after settling begins
/// with the row from which on position, force or both stay close to their rest, and with the tail
/// where that never comes or comes later.
struct WallContact {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  double rest = kNone;           // m
  double swing = kNone;          // m
  double force_swing = kNone;    // N
  double settled = kNone;        // s
  double peak = kNone;           // m
  double impact_share = kNone;   // 1
  double limit_cycle = kNone;    // Hz
  double least_energy = kNone;   // J
  double most_drawn = kNone;     // J
  double clamped_share = kNone;  // 1
  double force_step = kNone;     // N
  double most_pull = kNone;      // N
  double force_rest = kNone;     // N
  double force_settled = kNone;  // s
  double ripple = kNone;         // N
  double ripple_rms = kNone;     // N
  double ripple_high = kNone;    // N
  double jumps = kNone;          // 1
  double perceived = kNone;      // 1

  /// The position swings by less than 0.25 mm.
  bool still() const { return swing < kStillSwing; }
  /// The force settles before the tail, and its vibration is below three detection thresholds once
  /// the handle has rung down.
  bool force_quiet() const { return !std::isnan(force_settled) && perceived < kQuietPerceived; }
  /// Of what should be small the worse of this contact and of `other`, another axis of the same run: swings, steps, pulls,
  /// settling times and vibration. Places and energies stay.
  void take_worse(const WallContact& other);
  /// The one definition of a quiet contact behind every verdict, study, map, border and table.
  bool quiet() const { return still() && force_quiet(); }

  static constexpr auto fields() {
    using F = Field<WallContact>;
    return std::array{
        F{"rest", &WallContact::rest, "m", "mean position over the last 30 % of the run"},
        F{"swing", &WallContact::swing, "m", "position, peak to peak, over the last 30 %"},
        F{"force_swing", &WallContact::force_swing, "N",
          "applied force, peak to peak, over the last 30 %"},
        F{"settled", &WallContact::settled, "s",
          "time from the first row to where it stays within 0.125 mm of its rest"},
        F{"peak", &WallContact::peak, "m", "deepest position of the whole run"},
        F{"impact_share", &WallContact::impact_share, "1",
          "applied force over that of the virtual world, in the tick of the deepest position"},
        F{"limit_cycle", &WallContact::limit_cycle, "Hz",
          "frequency of the swing where it is not still"},
        F{"least_energy", &WallContact::least_energy, "J", "lowest physical port energy"},
        F{"most_drawn", &WallContact::most_drawn, "J",
          "most energy taken out in any window, beyond what an ideal wall stores at its start"},
        F{"clamped_share", &WallContact::clamped_share, "1",
          "share of ticks in which the law held back"},
        F{"force_step", &WallContact::force_step, "N",
          "largest change of the applied force from one tick to the next"},
        F{"most_pull", &WallContact::most_pull, "N",
          "hardest pull of the hand while the virtual world acts"},
        F{"force_rest", &WallContact::force_rest, "N",
          "mean applied force over the last 30 % of the run"},
        F{"force_settled", &WallContact::force_settled, "s",
          "time from the first row to where the applied force stays within 5 % or 0.2 N of its "
          "rest, the larger; none where that comes after the tail has begun"},
        F{"ripple", &WallContact::ripple, "N",
          "applied force, peak to peak, after position and force have settled"},
        F{"ripple_rms", &WallContact::ripple_rms, "N",
          "the same, root mean square around its mean"},
        F{"ripple_high", &WallContact::ripple_high, "N",
          "force above 20 Hz once it has rung down, root mean square"},
        F{"jumps", &WallContact::jumps, "1",
          "changes of the applied force by more than 0.2 N from one tick to the next, after the "
          "position has settled"},
        F{"perceived", &WallContact::perceived, "1",
          "largest vibration of the applied force, in detection thresholds, from twice the "
          "time in which the position settles, and 0.5 s after it has settled at least"},
    };
  }
};

/// The recording of one axis that a contact is measured from, row by row; a column that does not
/// exist is empty.
struct ContactRecord {
  std::span<const double> t{};        // s
  std::span<const double> x{};        // m
  std::span<const double> force{};    // N, applied
  std::span<const double> energy{};   // J, physical port energy of all axes
  std::span<const double> stored{};   // J, energy stored by an ideal environment at this position
  std::span<const double> clamped{};  // 0 or 1
  std::span<const double> pull{};     // N, of the hand; 0 where the virtual world does not act
  std::span<const double> wall{};     // N, of the virtual world
};

/// Measures a contact; throws std::invalid_argument for fewer than `kFewestRows` rows or columns of
/// several lengths.
WallContact measure_contact(const ContactRecord& record);

/// Whether the virtual world acts on this axis in the tail.
bool touched_at_end(const ContactRecord& record);

/// Energy that an ideal environment stores at a position: the sum of K depth^2/2.
double stored_energy(const Environment& environment, const Axes& x) EBAC_RT;

/// The same along a run, for a world that remembers where it was touched.
class StoredEnergy {
 public:
  StoredEnergy(const Environment& environment, const Kinematics& kinematics)
      : environment_(fresh(environment)), kinematics_(kinematics) {}

  /// In the next row: at position `x` [m] of the ports and time `t` [s]; the result in J.
  double at(const Axes& x, double t) EBAC_RT;

 private:
  Environment environment_;
  Kinematics kinematics_;
};

}  // namespace ebac
