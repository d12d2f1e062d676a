#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "ebac/core/matrix_exponential.hpp"
#include "ebac/identify/arm_record.hpp"
#include "ebac/identify/arm_step.hpp"

namespace ebac {

namespace {

/// What a change of some parameters does to a tick, one lane each.
template <class Lanes>
struct TickSlope {
  std::array<Lanes, 8> flow;        // of x from x, v, push, its change; of v from them
  Lanes of_target = Lanes::Zero();  // of the push, 1/s^2
  Lanes ahead = Lanes::Zero();      // of how far ahead of the hand it is read, s
  std::vector<double> force;        // of the force at each row, along `bend`
  Lanes bends = Lanes::Zero();      // of the push, for each of that
  std::vector<Lanes> held;          // of the push, over the tick from each row on

  explicit TickSlope(std::size_t rows) : held(rows, Lanes::Zero()) { flow.fill(Lanes::Zero()); }
};

/// The derivative of the exact step along a change of its generator.
Eigen::Matrix<double, 2, 4> flow_slope(const ArmGuess& guess, double dt, std::size_t index) {
  const double per_mass = 1 / guess.mass;
  Eigen::Matrix<double, 8, 8> a = Eigen::Matrix<double, 8, 8>::Zero();
  for (const int k : {0, 4}) {
    a(k, k + 1) = dt;
    a(k + 1, k) = -guess.stiffness * per_mass * dt;
    a(k + 1, k + 1) = -guess.damping * per_mass * dt;
    a(k + 1, k + 2) = dt;
    a(k + 2, k + 3) = 1;
  }
  if (index == ArmGuess::kMass) {
    a(1, 4) = -a(1, 0) * per_mass;
    a(1, 5) = -a(1, 1) * per_mass;
  } else {
    a(1, index == ArmGuess::kStiffness ? 4 : 5) = -per_mass * dt;
  }
  const Eigen::Matrix<double, 8, 8> flow = matrix_exponential(a);
  return flow.block<2, 4>(0, 4);
}

}  // namespace

void ArmRecord::linearised(std::span<const double> theta, const ArmGains& gains,
                           std::span<const std::size_t> which, std::span<double> errors,
                           std::span<double> out, std::size_t stride) const {
  if (stride == 0) stride = rows();
  const ArmGuess guess = ArmGuess::from(theta, inputs());
  const Drive drive = this->drive(guess, gains.ticks);
  constexpr std::size_t kMost = 8;
  std::size_t done = 0;
  do {
    const std::size_t many = std::min(kMost, which.size() - done);
    const auto some = which.subspan(done, many);
    const auto into = out.subspan(done * stride);
    if (many > 6) {
      columns<8>(guess, drive, gains, some, errors, into, stride);
    } else if (many > 4) {
      columns<6>(guess, drive, gains, some, errors, into, stride);
    } else {
      columns<4>(guess, drive, gains, some, errors, into, stride);
    }
    done += many;
  } while (done < which.size());
}

template <int kLanes>
void ArmRecord::columns(const ArmGuess& guess, const Drive& drive, const ArmGains& gains,
                        std::span<const std::size_t> which, std::span<double> errors,
                        std::span<double> out, std::size_t stride) const {
  using Lanes = Eigen::Array<double, kLanes, 1>;
  const std::size_t n = rows();
  const ArmStep step(guess, log_.dt);
  TickSlope<Lanes> slope(n);
  for (std::size_t k = 0; k < which.size(); ++k) {
    const auto lane = static_cast<Eigen::Index>(k);
    const std::size_t index = which[k];
    if (index <= ArmGuess::kStiffness) {
      Eigen::Matrix<double, 2, 4> d = flow_slope(guess, log_.dt, index);
      if (index == ArmGuess::kMass) {  // which weakens the push, too
        d.col(2) -= step.per_mass * step.start;
        d.col(3) -= step.per_mass * step.change;
      }
      for (int j = 0; j < 8; ++j) slope.flow[static_cast<std::size_t>(j)][lane] = d(j / 4, j % 4);
      if (index == ArmGuess::kStiffness) slope.of_target[lane] = step.per_mass;
      continue;
    }
    if (index == ArmGuess::kBend) {
      slope.bends[lane] = -step.per_mass;
      slope.force = bend_slope(gains.ticks);
      continue;
    }
    if (index == ArmGuess::kDelay) slope.ahead[lane] = 1;
    const std::size_t input = index - ArmGuess::kBeforeInputs;
    if (index >= ArmGuess::kBeforeInputs && input < inputs()) {
      for (std::size_t i = 0; i < n; ++i)
        slope.held[i][lane] = -step.per_mass * log_.inputs[input][i];
      continue;
    }
    const std::vector<double> target = target_slope(guess, gains.ticks, index);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      slope.held[i][lane] = step.per_mass * step.stiffness * target[i + 1];
    }
  }

  const double late = late_by(guess, gains.ticks);
  const double ahead = log_.lag + late, later = late - gains.late;
  const bool bending = !slope.force.empty();
  Eigen::Vector2d z = Eigen::Vector2d::Zero();
  double before = 0;
  double off = 0;
  Lanes dx = Lanes::Zero(), dv = dx, dbefore = dx, doff = dx;  // of the same
  for (std::size_t i = 0; i < n; ++i) {
    const ArmGains::Row& gain = gains.rows[i];
    if (gain.weight == 0) {  // left out: no reading
      errors[i] = 0;
      for (std::size_t k = 0; k < which.size(); ++k) out[k * stride + i] = 0;
    } else {
      const double early = log_.early[i];
      const double bend = early * early / log_.dt * (2.0 / 3.0);
      const double e = log_.x[i] - z[0] - (ahead - early) * z[1] - bend * (z[1] - before);
      errors[i] = e * gain.weight;
      const Lanes de = -dx - (ahead - early) * dv - slope.ahead * z[1] - bend * (dv - dbefore);
      const Lanes shown = de * gain.weight;
      for (std::size_t k = 0; k < which.size(); ++k) {
        out[k * stride + i] = shown[static_cast<Eigen::Index>(k)];
      }
      off += gain.drift * e;
      const double gain_x = gain.x - later * gain.v;
      z[0] += gain_x * e;
      z[1] += gain.v * e;
      if (gain.drift != 0) doff += gain.drift * de;
      dx += gain_x * de - slope.ahead * (gain.v * e);
      dv += gain.v * de;
    }
    if (i + 1 == n) break;
    before = z[1];
    dbefore = dv;
    const double beyond = drive.beyond[i] - off;
    const double now = step.push(drive.force[i] + beyond, drive.target[i + 1]);
    const double turn = step.push(drive.force[i + 1] + beyond, drive.target[i + 1]) - now;
    const auto& f = slope.flow;
    Lanes dnow = slope.held[i] + step.per_mass * doff + slope.of_target * drive.target[i + 1];
    if (bending) dnow += slope.bends * slope.force[i];
    Lanes x = step.phi(0, 0) * dx + step.phi(0, 1) * dv + step.start[0] * dnow + f[0] * z[0] +
              f[1] * z[1] + f[2] * now + f[3] * turn;
    dv = step.phi(1, 0) * dx + step.phi(1, 1) * dv + step.start[1] * dnow + f[4] * z[0] +
         f[5] * z[1] + f[6] * now + f[7] * turn;
    if (bending) {
      const Lanes dturn = slope.bends * (slope.force[i + 1] - slope.force[i]);
      x += step.change[0] * dturn;
      dv += step.change[1] * dturn;
    }
    dx = x;
    z = step.phi * z + step.start * now + step.change * turn;
  }
}

}  // namespace ebac
