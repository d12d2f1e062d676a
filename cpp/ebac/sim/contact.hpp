#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "ebac/core/fields.hpp"
#include "ebac/model/environment.hpp"

/// Metrics of a contact with a wall: the one definition behind `ebac.contact` and every sweep.
namespace ebac {

inline constexpr double kTailShare = 0.3;       // of a run, over which rest and swing are taken
inline constexpr double kQuietSwing = 0.25e-3;  // m, peak to peak; a smaller oscillation is quiet
inline constexpr std::size_t kFewestRows = 10;  // fewer have no tail to measure

/// A contact in numbers; NaN where a thing does not exist.
struct WallContact {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  double rest = kNone;           // m
  double swing = kNone;          // m
  double force_swing = kNone;    // N
  double settled = kNone;        // s
  double peak = kNone;           // m
  double limit_cycle = kNone;    // Hz
  double least_energy = kNone;   // J
  double most_drawn = kNone;     // J
  double clamped_share = kNone;  // 1
  double force_step = kNone;     // N
  double most_pull = kNone;      // N

  bool quiet() const { return swing < kQuietSwing; }

  static constexpr auto fields() {
    using F = Field<WallContact>;
    return std::array{
        F{"rest", &WallContact::rest, "m", "mean position over the last 30 % of the run"},
        F{"swing", &WallContact::swing, "m", "position, peak to peak, over the last 30 %"},
        F{"force_swing", &WallContact::force_swing, "N",
          "applied force, peak to peak, over the last 30 %"},
        F{"settled", &WallContact::settled, "s",
          "from when on it stays within 0.125 mm of its rest"},
        F{"peak", &WallContact::peak, "m", "deepest position of the whole run"},
        F{"limit_cycle", &WallContact::limit_cycle, "Hz",
          "frequency of the swing where it is not quiet"},
        F{"least_energy", &WallContact::least_energy, "J", "lowest physical port energy"},
        F{"most_drawn", &WallContact::most_drawn, "J",
          "most energy taken out in any window, beyond what an ideal wall stores at its start"},
        F{"clamped_share", &WallContact::clamped_share, "1",
          "share of ticks in which the law held back"},
        F{"force_step", &WallContact::force_step, "N",
          "largest change of the applied force from one tick to the next"},
        F{"most_pull", &WallContact::most_pull, "N",
          "hardest pull of the hand while the virtual world acts"},
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
};

/// Measures a contact; throws std::invalid_argument for fewer than `kFewestRows` rows or columns of
/// several lengths.
WallContact measure_contact(const ContactRecord& record);

/// Energy that an ideal environment stores at a position: the sum of K depth^2/2.
double stored_energy(const Environment& environment, const Axes& x) EBAC_RT;

}  // namespace ebac
