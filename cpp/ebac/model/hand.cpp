#include "ebac/model/hand.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace ebac {

namespace {
constexpr double kTurn = 2 * std::numbers::pi;

void refuse(bool wrong, const std::string& why) {
  if (wrong) throw std::invalid_argument("Recorded: " + why);
}
}  // namespace

double Sine::position(double t) const EBAC_RT {
  return centre + amplitude * std::sin(kTurn * frequency * t + phase);
}

double Tapping::position(double t) const EBAC_RT {
  const double cycles = frequency * t;
  return cycles - std::floor(cycles) < 0.5 ? target : rest;
}

Recorded::Recorded(std::vector<double> t, std::vector<double> x) {
  refuse(t.size() != x.size(), "t has " + std::to_string(t.size()) + " values and x " +
                                   std::to_string(x.size()) + "; give one position for each time");
  refuse(t.size() < 2, "needs at least 2 points, got " + std::to_string(t.size()));
  for (std::size_t i = 0; i < t.size(); ++i) {
    const std::string point = " at point " + std::to_string(i);
    refuse(!std::isfinite(t[i]) || !std::isfinite(x[i]), "not a finite number" + point);
    refuse(i > 0 && t[i] <= t[i - 1], "time does not rise" + point + "; sort the log by time");
  }
  points_ = std::make_shared<const Points>(Points{std::move(t), std::move(x)});
}

double Recorded::position(double t) const EBAC_RT {
  const auto& [times, xs] = *points_;
  if (t <= times.front()) return xs.front();
  if (t >= times.back()) return xs.back();
  const auto after =
      static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t) - times.begin());
  const double share = (t - times[after - 1]) / (times[after] - times[after - 1]);
  return xs[after - 1] + share * (xs[after] - xs[after - 1]);
}

Target Hand::moving_target(int axis, double t, double dt) const EBAC_RT {
  Target result = std::visit(
      [&](const auto& p) {
        const double x = p.position(t);
        if constexpr (std::decay_t<decltype(p)>::kContinuous) {
          return Target{x, (p.position(t + dt) - x) / dt};
        } else {
          return Target{x, 0};
        }
      },
      path[static_cast<std::size_t>(axis)]);
  if (tremor_amplitude > 0) {
    const Sine shake = tremor();
    const double x = shake.position(t);
    result.x += x;
    result.rate += (shake.position(t + dt) - x) / dt;
  }
  return result;
}

double Hand::pull(int axis, double t, double x) const EBAC_RT {
  if (t >= release_at) return 0;
  const double wanted = std::visit([&](const auto& p) EBAC_RT { return p.position(t); },
                                   path[static_cast<std::size_t>(axis)]);
  const double away = wanted - x + (tremor_amplitude > 0 ? tremor().position(t) : 0.0);
  return stiffness * std::abs(away);
}

}  // namespace ebac
