#include "ebac/identify/arm_record.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "ebac/core/check.hpp"
#include "ebac/identify/arm_spread.hpp"
#include "ebac/identify/arm_step.hpp"

namespace ebac {

namespace {

void refuse(bool wrong, const std::string& why) {
  if (wrong) throw std::invalid_argument("ArmRecord: " + why);
}

void require_numbers(const std::vector<double>& values, const std::string& name) {
  const auto wrong = std::find_if_not(values.begin(), values.end(),
                                      [](double value) { return std::isfinite(value); });
  refuse(wrong != values.end(),
         name + " has no finite number in row " + std::to_string(wrong - values.begin()));
}

}  // namespace

ArmGuess ArmGuess::from(std::span<const double> theta, std::size_t inputs) {
  for (std::size_t i = 0; i < theta.size(); ++i) {
    if (std::isfinite(theta[i])) continue;
    constexpr std::array<const char*, kBeforeInputs> kNames{"mass",  "damping", "stiffness",
                                                            "delay", "onset",   "bend"};
    const std::string name =
        i < kBeforeInputs ? kNames[i] : (i < kBeforeInputs + inputs ? "a share" : "a level");
    refuse(true, "theta[" + std::to_string(i) + "], " + name + ", = " + shortest(theta[i]) +
                     ": must be a finite number");
  }
  return {theta[0],
          theta[1],
          theta[2],
          theta[3],
          theta[4],
          theta[5],
          theta.subspan(kBeforeInputs, inputs),
          theta.subspan(kBeforeInputs + inputs)};
}

ArmRecord::ArmRecord(Log log) : log_(std::move(log)) {
  const std::size_t n = log_.x.size();
  refuse(n < 3, "needs at least 3 rows, got " + std::to_string(n));
  refuse(log_.force.size() != n || log_.variance.size() != n || log_.known.size() != n ||
             log_.early.size() != n || log_.doubt.size() != n,
         "x, force, variance, early, known and doubt must be equally long");
  for (const auto& input : log_.inputs) {
    refuse(input.size() != n, "an input must be as long as x");
    require_numbers(input, "an input");
  }
  refuse(log_.segments.size() != log_.switches.size() + 1, "needs one segment more than switches");
  refuse(!(log_.dt > 0 && std::isfinite(log_.dt)) || !(log_.lag >= 0 && std::isfinite(log_.lag)),
         "dt must be positive, lag not negative, and both finite");
  require_numbers(log_.x, "x");
  require_numbers(log_.force, "force");
  require_numbers(log_.early, "early");
  require_numbers(log_.known, "known");
  require_numbers(log_.doubt, "doubt");
  require_numbers(log_.switches, "switches");
  refuse(!std::is_sorted(log_.switches.begin(), log_.switches.end()), "switches must rise");
  for (const double v : log_.variance) refuse(!(v >= 0), "variance must not be negative");
  for (const int level : log_.segments) {
    refuse(level < 0, "a segment names a negative level");
    levels_ = std::max(levels_, static_cast<std::size_t>(level) + 1);
  }
  keep_ = log_.lag > 0 ? std::exp(-log_.dt / log_.lag) : 0.0;
}

ArmRecord ArmRecord::resting(std::vector<double> noise) const {
  refuse(noise.size() != rows(), "the noise must be as long as x");
  require_numbers(noise, "the noise");
  ArmRecord out(*this);
  out.log_.force = std::move(noise);
  std::ranges::fill(out.log_.x, 0.0);
  std::ranges::fill(out.log_.known, 0.0);
  for (auto& input : out.log_.inputs) std::ranges::fill(input, 0.0);
  return out;
}

/// Where the target jumps, the force jumps within a tick, which its samples do not resolve: the
/// size of the jump, for the rows it is felt in.
std::vector<double> ArmRecord::jumps(const ArmGuess& guess) const {
  std::vector<double> out(rows(), 0.0);
  const auto level = [&](std::size_t k) {
    return guess.levels[static_cast<std::size_t>(log_.segments[k])];
  };
  constexpr std::size_t kAround = 4;  // rows, more than a jump is felt in
  for (std::size_t k = 0; k < log_.switches.size(); ++k) {
    const double size = guess.stiffness * std::abs(level(k + 1) - level(k));
    const double at = log_.switches[k] + guess.onset + late_by(guess, whole_ticks(guess));
    const std::ptrdiff_t row = within(at / log_.dt, rows() + kAround);
    for (std::ptrdiff_t i = row - 2; i <= row + 3; ++i) {
      if (i >= 0 && i < static_cast<std::ptrdiff_t>(rows()))
        out[static_cast<std::size_t>(i)] = size;
    }
  }
  return out;
}

/// Makes the gains of a filter, one row after the other.
class ArmRecord::Maker {
 public:
  Maker(const ArmRecord& record, const ArmGuess& guess, const Noise& noise)
      : log_(record.log_),
        step_(guess, log_.dt),
        kick_(step_.start * step_.per_mass),
        q_(kick_[0] * kick_[0], kick_[0] * kick_[1], kick_[1] * kick_[1]),
        jumps_(record.jumps(guess)),
        ticks_(record.whole_ticks(guess)),
        late_(record.late_by(guess, ticks_)),
        variance_(noise.force * noise.force),
        wander_(noise.drift * noise.drift * log_.dt) {
    spread_.p22 = noise.offset * noise.offset;
  }

  ArmGains::Row next(std::size_t i) EBAC_RT {
    const double forward = log_.lag + late_ - log_.early[i];
    const ArmGains::Row row = spread_.weigh(log_.variance[i], forward, log_sum_);
    const double doubt = kJumpDoubt * jumps_[i];
    const double other = log_.doubt[i];
    spread_.move(step_.phi, kick_, q_ * (variance_ + doubt * doubt + other * other), wander_);
    return row;
  }

  double ticks() const { return ticks_; }
  double late() const { return late_; }
  double log_sum() const { return log_sum_.sum(); }

 private:
  const Log& log_;
  ArmStep step_;
  Eigen::Vector2d kick_;
  Eigen::Vector3d q_;
  std::vector<double> jumps_;  // N
  double ticks_, late_;
  double variance_, wander_;  // N^2
  ArmSpread spread_;
  LogSum log_sum_;
};

/// The motion of a guess one tick ahead, corrected by each reading.
class ArmRecord::Prediction {
 public:
  /// With gains that were made for some whole ticks of delay and the rest of it [s].
  Prediction(const ArmRecord& record, const ArmGuess& guess, double ticks, double made_for)
      : log_(record.log_),
        step_(guess, log_.dt),
        drive_(record.drive(guess, ticks)),
        ahead_(log_.lag + record.late_by(guess, ticks)),
        later_(record.late_by(guess, ticks) - made_for) {}

  /// The error of a row over its standard deviation.
  double next(std::size_t i, const ArmGains::Row& gain) EBAC_RT {
    const double early = log_.early[i];  // half a tick: the mean over the tick, with its bend
    const double bend = early * early / log_.dt * (2.0 / 3.0) * (z_[1] - before_);
    const double e = log_.x[i] - z_[0] - (ahead_ - early) * z_[1] - bend;
    off_ += gain.drift * e;
    if (i + 1 < log_.x.size()) {
      z_[0] += (gain.x - later_ * gain.v) * e;
      z_[1] += gain.v * e;
      before_ = z_[1];
      const double beyond = drive_.beyond[i] - off_;
      const double now = step_.push(drive_.force[i] + beyond, drive_.target[i + 1]);
      const double then = step_.push(drive_.force[i + 1] + beyond, drive_.target[i + 1]);
      z_ = step_.phi * z_ + step_.start * now + step_.change * (then - now);
    }
    return e * gain.weight;
  }

  /// By how much the force reads too high [N].
  double off() const EBAC_RT { return off_; }

 private:
  const Log& log_;
  ArmStep step_;
  Drive drive_;
  double ahead_, later_;                         // s
  Eigen::Vector2d z_ = Eigen::Vector2d::Zero();  // m, m/s
  double before_ = 0;                            // m/s, velocity a tick ago
  double off_ = 0;                               // N
};

ArmGains ArmRecord::gains(const ArmGuess& guess, const Noise& noise) const {
  Maker maker(*this, guess, noise);
  ArmGains out;
  out.ticks = maker.ticks();
  out.late = maker.late();
  out.rows.reserve(rows());
  for (std::size_t i = 0; i < rows(); ++i) out.rows.push_back(maker.next(i));
  out.log_sum = maker.log_sum();
  return out;
}

void ArmRecord::innovations(const ArmGuess& guess, const ArmGains& gains, std::span<double> out,
                            std::span<double> drifts) const {
  Prediction prediction(*this, guess, gains.ticks, gains.late);
  for (std::size_t i = 0; i < rows(); ++i) {
    out[i] = prediction.next(i, gains.rows[i]);
    if (!drifts.empty()) drifts[i] = prediction.off();
  }
}

void ArmRecord::simulate(const ArmGuess& guess, double x, double v, std::span<double> out) const {
  const ArmStep step(guess, log_.dt);
  const double ticks = whole_ticks(guess), ahead = log_.lag + late_by(guess, ticks);
  const Drive drive = this->drive(guess, ticks);
  Eigen::Vector2d z(x, v);
  for (std::size_t i = 0; i < rows(); ++i) {
    out[i] = z[0] + ahead * z[1];
    if (i + 1 == rows()) break;
    const double beyond = drive.beyond[i];
    const double now = step.push(drive.force[i] + beyond, drive.target[i + 1]);
    const double next = step.push(drive.force[i + 1] + beyond, drive.target[i + 1]);
    z = step.phi * z + step.start * now + step.change * (next - now);
  }
}

}  // namespace ebac
