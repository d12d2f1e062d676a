#include <algorithm>
#include <cmath>

#include "ebac/identify/arm_record.hpp"

namespace ebac {

namespace {

/// Straight pieces through samples weaken a sine by (w T)^2/12; this gives it back beforehand.
constexpr double kSharpen = 1.0 / 12;

/// Force readings some ticks later; at the ends the first and the last one hold.
struct Shifted {
  std::span<const double> force;  // N
  std::ptrdiff_t ticks;

  double operator()(std::ptrdiff_t row) const {
    const auto last = static_cast<std::ptrdiff_t>(force.size()) - 1;
    const auto at = row + ticks;
    return force[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, last))];
  }
  std::vector<double> column() const {
    std::vector<double> out(force.size());
    const auto rows = static_cast<std::ptrdiff_t>(force.size());
    for (std::ptrdiff_t i = 0; i < rows; ++i) out[static_cast<std::size_t>(i)] = (*this)(i);
    return out;
  }
  double curvature(std::ptrdiff_t row) const {
    return (*this)(row + 1) - 2 * (*this)(row) + (*this)(row - 1);
  }
};

}  // namespace

double ArmRecord::whole_ticks(const ArmGuess& guess) const {
  return std::round(guess.delay / log_.dt);
}

std::ptrdiff_t ArmRecord::within(double rows, std::size_t most) {
  const auto limit = static_cast<double>(most);
  return std::isnan(rows) ? 0 : static_cast<std::ptrdiff_t>(std::clamp(rows, -limit, limit));
}

double ArmRecord::late_by(const ArmGuess& guess, double ticks) const {
  return guess.delay - ticks * log_.dt;
}

/// The level of the target, averaged over the tick that ends at row `tick`.
double ArmRecord::mean_target(std::size_t tick, double onset, std::span<const double> levels,
                              std::size_t& segment) const {
  const double end = log_.dt * static_cast<double>(tick);
  double from = end - log_.dt;
  double sum = 0;
  const auto level = [&] { return levels[static_cast<std::size_t>(log_.segments[segment])]; };
  while (segment < log_.switches.size() && log_.switches[segment] + onset < end) {
    const double at = std::max(from, log_.switches[segment] + onset);
    sum += (at - from) * level();
    from = at;
    ++segment;
  }
  return (sum + (end - from) * level()) / log_.dt;
}

ArmRecord::Drive ArmRecord::drive(const ArmGuess& guess, double ticks) const {
  return {driving_force(guess, ticks), driving_inputs(guess), driving_target(guess, ticks)};
}

std::vector<double> ArmRecord::driving_force(const ArmGuess& guess, double ticks) const {
  const Shifted shifted{log_.force, within(ticks, rows() + 1)};  // from there on all hold the last
  std::vector<double> out = shifted.column();
  const double sharpen = kSharpen + guess.bend;
  double before = shifted(-1), here = out[0];
  const double last = shifted(static_cast<std::ptrdiff_t>(rows()));
  for (std::size_t i = 0; i < rows(); ++i) {
    const double after = i + 1 < rows() ? out[i + 1] : last;
    out[i] = here - sharpen * (after - 2 * here + before);
    before = here;
    here = after;
  }
  return out;
}

std::vector<double> ArmRecord::driving_inputs(const ArmGuess& guess) const {
  std::vector<double> out(rows());
  for (std::size_t k = 0; k < guess.shares.size(); ++k) {
    if (guess.shares[k] == 0) continue;
    for (std::size_t i = 0; i < rows(); ++i) out[i] += guess.shares[k] * log_.inputs[k][i];
  }
  return out;
}

std::vector<double> ArmRecord::driving_target(const ArmGuess& guess, double ticks) const {
  std::vector<double> out(rows());
  const double late = late_by(guess, ticks);
  const double share = 0.5 + late / log_.dt;
  std::size_t segment = 0;
  const double onset = guess.onset + late;
  out[0] = mean_target(0, onset, guess.levels, segment) + log_.known[0];
  for (std::size_t i = 1; i < rows(); ++i) {
    const double moves = log_.known[i] - log_.known[i - 1];
    out[i] = mean_target(i, onset, guess.levels, segment) + log_.known[i] - share * moves;
  }
  put_behind_lag(out);
  return out;
}

/// Replaces the mean over each tick by that behind the sensor's lag.
void ArmRecord::put_behind_lag(std::span<double> wanted) const {
  double y = wanted[0];
  wanted[0] = 0;
  if (log_.lag == 0) return;
  const double lagging = log_.lag / log_.dt * (1 - keep_);
  for (double& mean : wanted.subspan(1)) {
    const double now = mean;
    mean = now + (y - now) * lagging;
    y = now + (y - now) * keep_;
  }
}

std::vector<double> ArmRecord::target_slope(const ArmGuess& guess, double ticks,
                                            std::size_t index) const {
  std::vector<double> out(rows(), 0.0);
  std::size_t segment = 0;
  const double onset = guess.onset + late_by(guess, ticks);
  const std::size_t first_level = ArmGuess::kBeforeInputs + inputs();
  if (index >= first_level) {
    std::vector<double> one(levels_, 0.0);
    one[index - first_level] = 1;
    for (std::size_t i = 0; i < rows(); ++i) out[i] = mean_target(i, onset, one, segment);
  } else if (index == ArmGuess::kDelay || index == ArmGuess::kOnset) {
    for (std::size_t k = 0; k < log_.switches.size(); ++k) {  // later means longer before
      const auto level = [&](std::size_t part) {
        return guess.levels[static_cast<std::size_t>(log_.segments[part])];
      };
      const double at = log_.switches[k] + onset;
      double tick = std::floor(at / log_.dt);
      if (at >= log_.dt * tick) ++tick;
      if (tick < 0 || tick >= static_cast<double>(rows())) continue;
      out[static_cast<std::size_t>(tick)] += (level(k) - level(k + 1)) / log_.dt;
    }
    if (index == ArmGuess::kDelay) {
      for (std::size_t i = 1; i < rows(); ++i)
        out[i] -= (log_.known[i] - log_.known[i - 1]) / log_.dt;
    }
  } else {
    return out;
  }
  put_behind_lag(out);
  return out;
}

std::vector<double> ArmRecord::bend_slope(double ticks) const {
  const Shifted raw{log_.force, within(ticks, rows() + 1)};
  std::vector<double> out(rows());
  for (std::size_t i = 0; i < rows(); ++i) out[i] = -raw.curvature(static_cast<std::ptrdiff_t>(i));
  return out;
}

}  // namespace ebac
