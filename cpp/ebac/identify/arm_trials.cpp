#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ebac/identify/arm_record.hpp"
#include "ebac/identify/arm_spread.hpp"
#include "ebac/identify/arm_step.hpp"

namespace ebac {

namespace {

/// Factors of a product between two looks at whether it leaves the numbers.
constexpr int kFactors = 4;

/// A column of a log for each lane, or one for all of them.
template <class Lanes>
class Columns {
 public:
  /// `make` gives that of a trial; `alike` is whether two trials have the same.
  template <class Make, class Alike>
  Columns(std::size_t rows, std::size_t trials, const Make& make, const Alike& alike) {
    std::vector<std::vector<double>> own(trials);
    std::vector<std::size_t> from(trials, 0);
    for (std::size_t k = 0; k < trials; ++k) {
      while (from[k] < k && !alike(from[k], k)) ++from[k];
      if (from[k] == k) own[k] = make(k);
    }
    if (*std::max_element(from.begin(), from.end()) == 0) {
      one_ = std::move(own[0]);
      return;
    }
    each_.resize(rows);
    for (Eigen::Index lane = 0; lane < Lanes::SizeAtCompileTime; ++lane) {
      const auto& column = own[from[std::min(static_cast<std::size_t>(lane), trials - 1)]];
      for (std::size_t i = 0; i < rows; ++i) each_[i][lane] = column[i];
    }
  }

  Lanes operator()(std::size_t row) const EBAC_RT {
    return each_.empty() ? Lanes(Lanes::Constant(one_[row])) : each_[row];
  }

 private:
  std::vector<double> one_;
  std::vector<Lanes> each_;
};

/// Exact steps of some hands, entry by entry.
template <class Lanes>
struct Steps {
  Lanes xx, xv, vx, vv, x_start, v_start, x_change, v_change, per_mass, pull;

  void put(Eigen::Index lane, const ArmStep& step) {
    xx[lane] = step.phi(0, 0), xv[lane] = step.phi(0, 1);
    vx[lane] = step.phi(1, 0), vv[lane] = step.phi(1, 1);
    x_start[lane] = step.start[0], v_start[lane] = step.start[1];
    x_change[lane] = step.change[0], v_change[lane] = step.change[1];
    per_mass[lane] = step.per_mass, pull[lane] = step.stiffness * step.per_mass;
  }
};

template <class Lanes>
Lanes huber(const Lanes& e, double robust) {
  const Lanes a = e.abs();
  return (a <= robust).select(a * a, 2 * robust * a - robust * robust);
}

}  // namespace

/// Filters and their errors, one trial a lane; where none drifts, without what a drift needs.
template <int kLanes, bool kDrift>
void ArmRecord::side_by_side(std::span<const Trial> trials, double robust, std::span<double> costs,
                             std::span<double> errors) const {
  using Lanes = Eigen::Array<double, kLanes, 1>;
  const std::size_t n = rows(), used = trials.size();
  Steps<Lanes> made, step;
  Lanes ticks, forward, ahead, later, variance, wander, p22;
  for (Eigen::Index lane = 0; lane < kLanes; ++lane) {
    const Trial& trial = trials[std::min(static_cast<std::size_t>(lane), used - 1)];
    made.put(lane, ArmStep(trial.held, log_.dt));
    step.put(lane, ArmStep(trial.guess, log_.dt));
    ticks[lane] = whole_ticks(trial.held);
    const double late = late_by(trial.held, ticks[lane]);
    forward[lane] = log_.lag + late;
    ahead[lane] = log_.lag + late_by(trial.guess, ticks[lane]);
    later[lane] = ahead[lane] - forward[lane];
    variance[lane] = trial.noise.force * trial.noise.force;
    wander[lane] = trial.noise.drift * trial.noise.drift * log_.dt;
    p22[lane] = trial.noise.offset * trial.noise.offset;
  }
  const auto tick = [&](std::size_t k) { return ticks[static_cast<Eigen::Index>(k)]; };
  const auto same = [](std::span<const double> a, std::span<const double> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  };
  const Columns<Lanes> force(
      n, used, [&](std::size_t k) { return driving_force(trials[k].guess, tick(k)); },
      [&](std::size_t a, std::size_t b) {
        return tick(a) == tick(b) && trials[a].guess.bend == trials[b].guess.bend;
      });
  const Columns<Lanes> beyond(
      n, used, [&](std::size_t k) { return driving_inputs(trials[k].guess); },
      [&](std::size_t a, std::size_t b) {
        return same(trials[a].guess.shares, trials[b].guess.shares);
      });
  const Columns<Lanes> target(
      n, used, [&](std::size_t k) { return driving_target(trials[k].guess, tick(k)); },
      [&](std::size_t a, std::size_t b) {
        const ArmGuess &one = trials[a].guess, &other = trials[b].guess;
        return tick(a) == tick(b) && one.delay == other.delay && one.onset == other.onset &&
               same(one.levels, other.levels);
      });
  const Columns<Lanes> jump(
      n, used, [&](std::size_t k) { return jumps(trials[k].held); },
      [&](std::size_t a, std::size_t b) {
        const ArmGuess &one = trials[a].held, &other = trials[b].held;
        return log_.switches.empty() ||
               (one.stiffness == other.stiffness && one.delay == other.delay &&
                one.onset == other.onset && same(one.levels, other.levels));
      });

  const bool jumping = !log_.switches.empty();
  const Lanes kick_x = made.x_start * made.per_mass, kick_v = made.v_start * made.per_mass;
  Lanes p00 = Lanes::Constant(ArmSpread::kFreePosition), p01 = Lanes::Zero(),
        p11 = Lanes::Constant(ArmSpread::kFreeVelocity), p02 = Lanes::Zero(), p12 = Lanes::Zero();
  Lanes x = Lanes::Zero(), v = x, before = x, off = x;
  Lanes cost = Lanes::Zero(), product = Lanes::Ones(), logs = Lanes::Zero();
  int factors = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Lanes shown = Lanes::Zero();
    if (!std::isinf(log_.variance[i])) {
      const double early = log_.early[i];
      const Lanes at = forward - early;
      const Lanes c0 = p00 + at * p01;
      const Lanes c1 = p01 + at * p11;
      const Lanes s = c0 + at * c1 + log_.variance[i];
      const Lanes certainty = s.inverse();
      const Lanes gain_x = c0 * certainty, gain_v = c1 * certainty;
      p00 -= c0 * gain_x;
      p01 -= c0 * gain_v;
      p11 -= c1 * gain_v;
      product *= s;
      if (++factors == kFactors) {
        factors = 0;
        if (product.minCoeff() < 1e-200 || product.maxCoeff() > 1e200) {
          logs += product.log();
          product.setOnes();
        }
      }
      const double bend = early * early / log_.dt * (2.0 / 3.0);
      const Lanes e = log_.x[i] - x - (ahead - early) * v - bend * (v - before);
      if constexpr (kDrift) {
        const Lanes c2 = p02 + at * p12;
        const Lanes gain = c2 * certainty;
        p02 -= c0 * gain;
        p12 -= c1 * gain;
        p22 -= c2 * gain;
        off += gain * e;
      }
      if (robust > 0 || !errors.empty()) {
        shown = e * certainty.sqrt();
        cost += robust > 0 ? huber(shown, robust) : Lanes(shown * shown);
      } else {
        cost += e * e * certainty;
      }
      x += (gain_x - later * gain_v) * e;
      v += gain_v * e;
    }
    for (std::size_t k = 0; k < used && !errors.empty(); ++k) {
      errors[k * n + i] = shown[static_cast<Eigen::Index>(k)];
    }
    if (i + 1 == n) break;
    before = v;
    const Lanes more = beyond(i) - off;
    const Lanes pulled = step.pull * target(i + 1);
    const Lanes now = pulled - step.per_mass * (force(i) + more);
    const Lanes turn = step.per_mass * (force(i) - force(i + 1));
    const Lanes ahead_x = step.xx * x + step.xv * v + step.x_start * now + step.x_change * turn;
    v = step.vx * x + step.vv * v + step.v_start * now + step.v_change * turn;
    x = ahead_x;

    Lanes noise = variance + log_.doubt[i] * log_.doubt[i];
    if (jumping) noise += (kJumpDoubt * jump(i)).square();
    Lanes a = made.xx * p00 + made.xv * p01, b = made.xx * p01 + made.xv * p11;
    Lanes c = made.vx * p00 + made.vv * p01, d = made.vx * p01 + made.vv * p11;
    Lanes noise_x = noise * kick_x, noise_v = noise * kick_v;
    if constexpr (kDrift) {
      a += kick_x * p02, b += kick_x * p12, c += kick_v * p02, d += kick_v * p12;
      const Lanes g = made.xx * p02 + made.xv * p12 + kick_x * p22;
      const Lanes h = made.vx * p02 + made.vv * p12 + kick_v * p22;
      noise_x += g, noise_v += h;
      p02 = g;
      p12 = h;
      p22 += wander;
    }
    p00 = a * made.xx + b * made.xv + noise_x * kick_x;
    p01 = a * made.vx + b * made.vv + noise_x * kick_v;
    p11 = c * made.vx + d * made.vv + noise_v * kick_v;
  }
  logs += product.log();
  for (std::size_t k = 0; k < used; ++k) {
    costs[k] = cost[static_cast<Eigen::Index>(k)] + logs[static_cast<Eigen::Index>(k)];
  }
}

void ArmRecord::judge(std::span<const Trial> trials, double robust, std::span<double> costs,
                      std::span<double> errors) const {
  constexpr std::size_t kMost = 4;  // of more, numbers leave the registers
  for (std::size_t done = 0; done < trials.size(); done += kMost) {
    const auto some = trials.subspan(done, std::min(kMost, trials.size() - done));
    const auto each = costs.subspan(done, some.size());
    const auto rows = errors.empty() ? errors : errors.subspan(done * this->rows());
    const bool drift = std::any_of(some.begin(), some.end(), [](const Trial& trial) {
      return trial.noise.drift > 0 || trial.noise.offset > 0;
    });
    const auto run = [&]<int kLanes> {
      return drift ? side_by_side<kLanes, true>(some, robust, each, rows)
                   : side_by_side<kLanes, false>(some, robust, each, rows);
    };
    if (some.size() > 2) {
      run.template operator()<4>();
    } else {
      run.template operator()<2>();
    }
  }
}

void ArmRecord::renewed(std::span<const double> theta, std::span<const double> held,
                        const Noise& noise, std::span<const std::size_t> which, std::size_t kept,
                        std::span<const double> steps, std::span<double> errors,
                        std::span<double> out, std::size_t stride) const {
  const std::size_t n = rows(), moves = which.size();
  std::vector<std::vector<double>> at(moves, {theta.begin(), theta.end()});
  std::vector<std::vector<double>> made(moves, {held.begin(), held.end()});
  std::vector<Trial> trials{
      {ArmGuess::from(theta, inputs()), ArmGuess::from(held, inputs()), noise}};
  for (std::size_t i = 0; i < moves; ++i) {
    const std::size_t k = which[i];
    at[i][k] += steps[i];
    if (i + kept < moves) made[i][k] += steps[i];
    trials.push_back({ArmGuess::from(at[i], inputs()), ArmGuess::from(made[i], inputs()), noise});
  }
  if (stride == 0) stride = n;
  std::vector<double> costs(trials.size()), every(trials.size() * n);
  judge(trials, 0, costs, every);
  std::copy_n(every.begin(), n, errors.begin());
  for (std::size_t i = 0; i < moves; ++i) {
    const double* moved = every.data() + (i + 1) * n;
    for (std::size_t row = 0; row < n; ++row) {
      out[i * stride + row] = (moved[row] - every[row]) / steps[i];
    }
  }
}

}  // namespace ebac
