#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Parameters of the hand of eq. (4) in a fit: those common to all recordings, then those of each.
///
/// As a vector: mass, damping, stiffness, delay, onset, bend, one share for each input of the log,
/// then the levels of the target.
struct ArmGuess {
  enum Index : std::size_t { kMass, kDamping, kStiffness, kDelay, kOnset, kBend, kBeforeInputs };

  double mass = 0.15;      // kg
  double damping = 6;      // N s/m
  double stiffness = 300;  // N/m
  double delay = 0;        // s, of the force reading behind the motion
  double onset = 0;        // s, of the target behind its switches: reaction time
  double bend = 0;         // 1, of second differences of the force, for its course between two rows
  std::span<const double> shares{};  // of the inputs; each product is a force [N]
  std::span<const double> levels{};  // m

  /// Throws std::invalid_argument for a theta that has no finite number somewhere.
  static ArmGuess from(std::span<const double> theta, std::size_t inputs);
};

/// Gains of a Kalman filter, made for one guess and kept during a search, so that its errors are
/// those of a plain least-squares problem.
///
/// They correct the motion at the instant of the reading. Where a guess has that at another instant
/// than the one they were made for, the position is corrected by as much less as the correction of
/// the velocity moves it: an unknown initial state stays free.
struct ArmGains {
  struct Row {
    double x = 0;       // 1
    double v = 0;       // 1/s
    double drift = 0;   // N/m
    double weight = 0;  // 1/m, one over the standard deviation of the error
  };
  std::vector<Row> rows;
  double log_sum = 0;  // of the logarithms of the variances
  double ticks = 0;    // of the delay they were made for, in whole: by these a force is shifted
  double late = 0;     // s, the rest of it
};

/// A log of one hand, and how well eq. (4) predicts it.
///
/// The recorded force drives the hand; its position is predicted one tick ahead by a Kalman filter
/// and compared with the encoder. Force noise enters as an input, a count as noise of the output,
/// so that the errors are white when model and noise are right. The initial state is free.
///
/// The force sensor's lag is put on the motion instead: the hand is linear, so a lagged force moves
/// a lagged hand xl, and x = xl + lag xl'. A position may be read `early` before the row's instant:
/// where a count changes, the handle crossed its edge somewhere in the tick before.
class ArmRecord {
 public:
  struct Log {
    std::vector<double> x;         // m, as read
    std::vector<double> force;     // N, of the hand on the handle
    std::vector<double> variance;  // m^2, of each position; infinite for one to leave out
    std::vector<double> early;     // s, how long before the row each position was true
    std::vector<double> known;     // m, known part of the target
    std::vector<double>
        doubt;  // N, standard deviation of other forces over the tick from each row on
    std::vector<std::vector<double>>
        inputs;                    // mean force over the tick from each row on, per share
    std::vector<double> switches;  // s after the first row, rising: the target goes to the next
    std::vector<int> segments;     // index into the levels, one more than switches
    double dt = 1e-3;              // s
    double lag = 0;                // s, of the force sensor
  };

  /// Throws std::invalid_argument when the lists do not fit each other or hold no number.
  explicit ArmRecord(Log log);

  /// The same log of a hand at rest in its place, whose force is but noise [N].
  ArmRecord resting(std::vector<double> noise) const;

  std::size_t rows() const { return log_.x.size(); }
  std::size_t inputs() const { return log_.inputs.size(); }
  std::size_t parameters() const { return ArmGuess::kBeforeInputs + inputs() + levels_; }

  struct Noise {
    double force = 0;   // N, standard deviation of a reading
    double drift = 0;   // N/sqrt(s), of a random walk by which it reads too high
    double offset = 0;  // N, within which that begins
  };
  ArmGains gains(const ArmGuess& guess, const Noise& noise) const;

  /// Writes the errors of one tick ahead, each over its standard deviation, and where asked for by
  /// how much the force reads too high [N].
  void innovations(const ArmGuess& guess, const ArmGains& gains, std::span<double> out,
                   std::span<double> drifts = {}) const;

  /// Writes the innovations, and d innovations / d theta[which[i]], one column after the other:
  /// exact, by forward sensitivities. Columns lie `stride` apart, by default the rows. Along `onset`, where a switch falls on a row, towards later.
  void linearised(std::span<const double> theta, const ArmGains& gains,
                  std::span<const std::size_t> which, std::span<double> errors,
                  std::span<double> out, std::size_t stride = 0) const;

  /// A guess, what its filter is made for, and the noise that is made for.
  struct Trial {
    ArmGuess guess, held;
    Noise noise;
  };
  /// Writes -2 log of the likelihood of each trial, but for a constant, and where asked for its
  /// innovations, one column after the other. Errors beyond `robust` deviations count linearly
  /// (Huber), 0 for none. Several trials take little longer than one: each row waits for the one
  /// before, and they do so side by side.
  void judge(std::span<const Trial> trials, double robust, std::span<double> costs,
             std::span<double> errors = {}) const;

  /// Writes the innovations and their derivatives as `linearised` does, with the gains made anew
  /// for each change, from `held` changed alike but for the last `kept`; by differences of `steps`.
  void renewed(std::span<const double> theta, std::span<const double> held, const Noise& noise,
               std::span<const std::size_t> which, std::size_t kept, std::span<const double> steps,
               std::span<double> errors, std::span<double> out, std::size_t stride = 0) const;

  /// Writes the position at each row that the recorded force alone gives from a state [m, m/s] on.
  void simulate(const ArmGuess& guess, double x, double v, std::span<double> out) const;

 private:
  class Maker;
  class Prediction;
  struct Drive {
    std::vector<double> force;   // N, at each tick
    std::vector<double> beyond;  // N, what its mean over the tick from there lies above that
    std::vector<double> target;  // m, mean over the tick before, behind the lag
  };

  /// The delay is put on the motion but for some whole ticks, by which the force is shifted.
  Drive drive(const ArmGuess& guess, double ticks) const;
  std::vector<double> driving_force(const ArmGuess& guess, double ticks) const;
  std::vector<double> driving_inputs(const ArmGuess& guess) const;
  std::vector<double> driving_target(const ArmGuess& guess, double ticks) const;
  template <int kLanes, bool kDrift>
  void side_by_side(std::span<const Trial> trials, double robust, std::span<double> costs,
                    std::span<double> errors) const;
  /// d target / d theta[index] [m per unit], and d force / d bend [N].
  std::vector<double> target_slope(const ArmGuess& guess, double ticks, std::size_t index) const;
  std::vector<double> bend_slope(double ticks) const;
  void put_behind_lag(std::span<double> wanted) const;
  /// `linearised` for a few parameters that are computed side by side.
  template <int kLanes>
  void columns(const ArmGuess& guess, const Drive& drive, const ArmGains& gains,
               std::span<const std::size_t> which, std::span<double> errors, std::span<double> out,
               std::size_t stride) const;
  /// The delay in whole ticks, by which the force is shifted; and the rest of it, which is put on
  /// the motion as the lag is: a force between two rows would be an average, and less noisy than
  /// one at a row, which a fit takes for a reason to prefer it. In a search the ticks stay those of
  /// the gains, so that nothing jumps.
  double whole_ticks(const ArmGuess& guess) const;
  /// A number of rows, without its fraction, within `most` in either direction; 0 for NaN.
  static std::ptrdiff_t within(double rows, std::size_t most);
  double late_by(const ArmGuess& guess, double ticks) const;  // s
  std::vector<double> jumps(const ArmGuess& guess) const;     // N
  double mean_target(std::size_t tick, double onset, std::span<const double> levels,
                     std::size_t& segment) const;

  /// How much of a jump a tick may miss.
  static constexpr double kJumpDoubt = 0.3;

  Log log_;
  std::size_t levels_ = 0;
  double keep_ = 0;  // share that a lagged signal keeps over a tick
};

}  // namespace ebac
