#include "ebac/identify/arm_record.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

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

/// How much of a jump a tick may miss.
constexpr double kJumpDoubt = 0.3;

/// A sum of logarithms, of which few are taken: products are ten times faster.
class LogSum {
 public:
  void add(double value) EBAC_RT {
    product_ *= value;
    if (product_ > 1e-200 && product_ < 1e200) return;
    sum_ += std::log(product_);
    product_ = 1;
  }
  double sum() const { return sum_ + std::log(product_); }

 private:
  double product_ = 1, sum_ = 0;
};

/// Covariance of position, velocity and the drift of the force reading, predicted.
struct Spread {
  static constexpr double kFreePosition = 1;  // m^2: no information on the position of a handle
  static constexpr double kFreeVelocity = 1e2;

  double p00 = kFreePosition, p01 = 0, p11 = kFreeVelocity;
  double p02 = 0, p12 = 0, p22 = 0;

  /// Takes a reading of x + forward v of some variance in.
  ArmGains::Row weigh(double variance, double forward, LogSum& log_sum) EBAC_RT {
    if (std::isinf(variance)) return {};
    const double c0 = p00 + forward * p01;
    const double c1 = p01 + forward * p11;
    const double c2 = p02 + forward * p12;
    const double s = c0 + forward * c1 + variance;
    const double certainty = 1 / s;
    const ArmGains::Row row{c0 * certainty, c1 * certainty, c2 * certainty, std::sqrt(certainty)};
    p00 -= c0 * row.x;
    p01 -= c0 * row.v;
    p11 -= c1 * row.v;
    p02 -= c0 * row.drift;
    p12 -= c1 * row.drift;
    p22 -= c2 * row.drift;
    log_sum.add(s);
    return row;
  }

  /// The drift moves on by a variance, after it has kicked position and velocity over the tick.
  void move(const Eigen::Matrix2d& f, const Eigen::Vector2d& kick, const Eigen::Vector3d& q,
            double drift) EBAC_RT {
    const double a = f(0, 0) * p00 + f(0, 1) * p01 + kick[0] * p02;
    const double b = f(0, 0) * p01 + f(0, 1) * p11 + kick[0] * p12;
    const double c = f(1, 0) * p00 + f(1, 1) * p01 + kick[1] * p02;
    const double d = f(1, 0) * p01 + f(1, 1) * p11 + kick[1] * p12;
    const double g = f(0, 0) * p02 + f(0, 1) * p12 + kick[0] * p22;
    const double h = f(1, 0) * p02 + f(1, 1) * p12 + kick[1] * p22;
    p00 = a * f(0, 0) + b * f(0, 1) + g * kick[0] + q[0];
    p01 = a * f(1, 0) + b * f(1, 1) + g * kick[1] + q[1];
    p11 = c * f(1, 0) + d * f(1, 1) + h * kick[1] + q[2];
    p02 = g;
    p12 = h;
    p22 += drift;
  }
};

}  // namespace

ArmGuess ArmGuess::from(std::span<const double> theta, std::size_t inputs) {
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
  refuse(!(log_.dt > 0) || !(log_.lag >= 0), "dt must be positive and lag not negative");
  require_numbers(log_.x, "x");
  require_numbers(log_.force, "force");
  require_numbers(log_.known, "known");
  require_numbers(log_.doubt, "doubt");
  refuse(!std::is_sorted(log_.switches.begin(), log_.switches.end()), "switches must rise");
  for (const double v : log_.variance) refuse(!(v >= 0), "variance must not be negative");
  for (const int level : log_.segments) {
    refuse(level < 0, "a segment names a negative level");
    levels_ = std::max(levels_, static_cast<std::size_t>(level) + 1);
  }
  keep_ = log_.lag > 0 ? std::exp(-log_.dt / log_.lag) : 0.0;
}

/// Where the target jumps, the force jumps within a tick, which its samples do not resolve: the
/// size of the jump, for the rows it is felt in.
std::vector<double> ArmRecord::jumps(const ArmGuess& guess) const {
  std::vector<double> out(rows(), 0.0);
  const auto level = [&](std::size_t k) {
    return guess.levels[static_cast<std::size_t>(log_.segments[k])];
  };
  for (std::size_t k = 0; k < log_.switches.size(); ++k) {
    const double size = guess.stiffness * std::abs(level(k + 1) - level(k));
    const double at = log_.switches[k] + guess.onset + late_by(guess, whole_ticks(guess));
    const auto row = static_cast<std::ptrdiff_t>(at / log_.dt);
    for (std::ptrdiff_t i = row - 2; i <= row + 3; ++i) {
      if (i >= 0 && i < static_cast<std::ptrdiff_t>(rows()))
        out[static_cast<std::size_t>(i)] = size;
    }
  }
  return out;
}

ArmGains ArmRecord::gains(const ArmGuess& guess, double force_noise, double drift,
                          double offset) const {
  const ArmStep step(guess, log_.dt);
  const Eigen::Vector2d kick = step.start * step.per_mass;
  const Eigen::Vector3d q(kick[0] * kick[0], kick[0] * kick[1], kick[1] * kick[1]);
  const std::vector<double> jumps = this->jumps(guess);
  ArmGains out;
  out.ticks = whole_ticks(guess);
  out.late = late_by(guess, out.ticks);
  out.rows.reserve(rows());
  Spread spread;
  LogSum log_sum;
  spread.p22 = offset * offset;
  const double wander = drift * drift * log_.dt;
  for (std::size_t i = 0; i < rows(); ++i) {
    const double forward = log_.lag + out.late - log_.early[i];
    out.rows.push_back(spread.weigh(log_.variance[i], forward, log_sum));
    const double doubt = kJumpDoubt * jumps[i];
    const double other = log_.doubt[i];
    spread.move(step.phi, kick, q * (force_noise * force_noise + doubt * doubt + other * other),
                wander);
  }
  out.log_sum = log_sum.sum();
  return out;
}

void ArmRecord::innovations(const ArmGuess& guess, const ArmGains& gains, std::span<double> out,
                            std::span<double> drifts) const {
  const ArmStep step(guess, log_.dt);
  const Drive drive = this->drive(guess, gains.ticks);
  const double late = late_by(guess, gains.ticks);
  const double ahead = log_.lag + late, later = late - gains.late;  // s
  Eigen::Vector2d z = Eigen::Vector2d::Zero();
  double before = 0;  // m/s, velocity a tick ago
  double off = 0;     // N, by which the force reads too high
  for (std::size_t i = 0; i < rows(); ++i) {
    const ArmGains::Row& gain = gains.rows[i];
    const double early = log_.early[i];  // half a tick: the mean over the tick, with its bend
    const double bend = early * early / log_.dt * (2.0 / 3.0) * (z[1] - before);
    const double e = log_.x[i] - z[0] - (ahead - early) * z[1] - bend;
    out[i] = e * gain.weight;
    off += gain.drift * e;
    if (!drifts.empty()) drifts[i] = off;
    if (i + 1 == rows()) break;
    z[0] += (gain.x - later * gain.v) * e;
    z[1] += gain.v * e;
    before = z[1];
    const double beyond = drive.beyond[i] - off;
    const double now = step.push(drive.force[i] + beyond, drive.target[i + 1]);
    const double next = step.push(drive.force[i + 1] + beyond, drive.target[i + 1]);
    z = step.phi * z + step.start * now + step.change * (next - now);
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
