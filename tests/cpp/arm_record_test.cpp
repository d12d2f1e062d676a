#include "ebac/identify/arm_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "ebac/identify/arm_step.hpp"

namespace ebac::arm_record_test {
namespace {

constexpr double kDt = 1e-3;  // s
constexpr std::size_t kRows = 600;
constexpr std::size_t kDelay = 3;                                // place in theta
constexpr std::size_t kShare = 6;                                // of the first input
const std::vector<double> kHand{0.2, 5, 300, 0, 0, 0, 0, 0.03};  // one input, one level

/// An informative force, though no hand makes it: two sines.
std::vector<double> wave(double delay = 0) {
  std::vector<double> out(kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    const double t = kDt * static_cast<double>(i) - delay;
    out[i] = 3 * std::sin(2 * std::numbers::pi * 2.5 * t) + std::sin(2 * std::numbers::pi * 7 * t);
  }
  return out;
}

ArmRecord::Log log_of(std::vector<double> force) {
  ArmRecord::Log log;
  log.x.assign(kRows, 0.0);
  log.force = std::move(force);
  log.variance.assign(kRows, 1e-12);
  log.early.assign(kRows, 0.0);
  log.known.assign(kRows, 0.0);
  log.doubt.assign(kRows, 0.0);
  log.inputs.assign(1, std::vector<double>(kRows, 0.0));
  log.segments = {0};
  log.dt = kDt;
  return log;
}

std::vector<double> simulated(const ArmRecord& record, const std::vector<double>& theta) {
  std::vector<double> x(kRows);
  record.simulate(ArmGuess::from(theta, record.inputs()), 0.01, 0.0, x);
  return x;
}

/// The largest error after the filter has settled, as a share of a deviation.
double worst(const ArmRecord& record, const std::vector<double>& theta, std::size_t skip = 50) {
  const ArmGuess guess = ArmGuess::from(theta, record.inputs());
  std::vector<double> e(kRows);
  record.innovations(guess, record.gains(guess, {.force = 0.01}), e);
  double most = 0;
  for (std::size_t i = skip; i < kRows; ++i) most = std::max(most, std::abs(e[i]));
  return most;
}

TEST(ArmStep, IsExactForAMassAlone) {
  ArmGuess guess{.mass = 2, .damping = 0, .stiffness = 0};
  const ArmStep step(guess, 0.1);
  const double push = step.push(-4, 0);  // N on 2 kg
  const Eigen::Vector2d z = step.phi * Eigen::Vector2d(1, 3) + step.start * push;
  EXPECT_NEAR(z[0], 1 + 3 * 0.1 + 0.5 * 2 * 0.01, 1e-12);
  EXPECT_NEAR(z[1], 3 + 2 * 0.1, 1e-12);
}

TEST(ArmStep, AgreesWithFineEulerSteps) {
  const ArmGuess guess{.mass = 0.3, .damping = 7, .stiffness = 400};
  const ArmStep step(guess, kDt);
  const double now = step.push(2, 0.01);
  const double next = step.push(5, 0.01);
  const Eigen::Vector2d z =
      step.phi * Eigen::Vector2d(0.002, 0.1) + step.start * now + step.change * (next - now);
  double x = 0.002;
  double v = 0.1;
  constexpr int kFine = 200000;
  for (int i = 0; i < kFine; ++i) {
    const double push = now + (next - now) * (i + 0.5) / kFine;
    const double a = push - (7 * v + 400 * x) / 0.3;
    x += kDt / kFine * (v + 0.5 * a * kDt / kFine);
    v += kDt / kFine * a;
  }
  EXPECT_NEAR(z[0], x, 1e-10);
  EXPECT_NEAR(z[1], v, 1e-7);
}

TEST(ArmRecord, TheTrueHandLeavesNoErrors) {
  ArmRecord::Log log = log_of(wave());
  log.x = simulated(ArmRecord(log), kHand);
  const ArmRecord record(log);
  EXPECT_LT(worst(record, kHand), 1e-3);
  std::vector<double> other = kHand;
  other[0] *= 1.05;
  EXPECT_GT(worst(record, other), 1.0);
}

TEST(ArmRecord, ALaggedForceMovesALaggedHand) {
  ArmRecord::Log log = log_of(wave());
  const std::vector<double> x = simulated(ArmRecord(log), kHand);
  log.lag = 2e-3;
  const std::vector<double> ahead = simulated(ArmRecord(log), kHand);
  for (std::size_t i = 100; i + 100 < kRows; i += 50) {
    const double v = (x[i + 1] - x[i - 1]) / (2 * kDt);
    EXPECT_NEAR(ahead[i], x[i] + 2e-3 * v, 2e-6) << i;
  }
}

TEST(ArmRecord, ADelayIsFoundInWholeAndInPartsOfATick) {
  ArmRecord::Log log = log_of(wave());
  log.x = simulated(ArmRecord(log), kHand);
  for (const double delay : {2e-3, 0.3e-3, 1.4e-3}) {
    ArmRecord::Log late = log;
    late.force = wave(delay);
    const ArmRecord record(late);
    std::vector<double> theta = kHand;
    const double without = worst(record, theta, 100);
    theta[kDelay] = delay;
    EXPECT_LT(worst(record, theta, 100), 0.02 * without) << delay;
  }
}

TEST(ArmRecord, AnInputIsAForceByItsShare) {
  ArmRecord::Log log = log_of(wave());
  for (std::size_t i = 0; i < kRows; ++i) log.inputs[0][i] = i % 100 < 50 ? 1.0 : -1.0;
  std::vector<double> theta = kHand;
  theta[kShare] = 0.7;
  log.x = simulated(ArmRecord(log), theta);
  const ArmRecord record(log);
  EXPECT_LT(worst(record, theta), 1e-3);
  EXPECT_GT(worst(record, kHand), 1.0);
}

TEST(ArmRecord, WhatIsLeftOutTellsNothing) {
  ArmRecord::Log log = log_of(wave());
  log.x = simulated(ArmRecord(log), kHand);
  for (std::size_t i = 0; i < kRows; i += 2) {
    log.x[i] = 99;
    log.variance[i] = std::numeric_limits<double>::infinity();
  }
  EXPECT_LT(worst(ArmRecord(log), kHand), 1e-3);
}

TEST(ArmRecord, DoubtLetsTheHandGo) {
  ArmRecord::Log log = log_of(wave());
  for (std::size_t i = 300; i < 308; ++i) log.inputs[0][i] = 50;  // an unrecorded push
  std::vector<double> pushed = kHand;
  pushed[kShare] = 1;
  log.x = simulated(ArmRecord(log), pushed);
  log.inputs[0].assign(kRows, 0.0);
  EXPECT_GT(worst(ArmRecord(log), kHand), 50.0);
  for (std::size_t i = 299; i < 309; ++i) log.doubt[i] = 100;
  EXPECT_LT(worst(ArmRecord(log), kHand), 2.0);
}

/// Trials that differ in all that may differ, with readings left out and a target that jumps.
TEST(ArmRecord, TrialsSideBySideGiveWhatGainsAndPredictionGive) {
  ArmRecord::Log log = log_of(wave());
  log.x = simulated(ArmRecord(log), kHand);
  log.switches = {0.2, 0.4};
  log.segments = {0, 1, 0};
  for (std::size_t i = 0; i < kRows; i += 3) {
    log.variance[i] = std::numeric_limits<double>::infinity();
    log.early[i + 1] = 0.3 * kDt;
  }
  for (std::size_t i = 0; i < kRows; ++i) log.inputs[0][i] = 0.01 * static_cast<double>(i % 7);
  const ArmRecord record(log);
  std::vector<std::vector<double>> thetas(7, {0.2, 5, 300, 0, 0, 0, 0.5, 0.03, 0.01});
  thetas[1][ArmGuess::kMass] *= 1.1;
  thetas[2][ArmGuess::kDelay] = 3e-4;
  thetas[3][ArmGuess::kOnset] = 2e-4;
  thetas[4][ArmGuess::kBend] = 0.01;
  thetas[5][kShare] = 0.3;
  thetas[6].back() = 0.02;
  const ArmGuess held = ArmGuess::from(thetas[0], 1);
  for (const double drift : {0.0, 0.1}) {
    std::vector<ArmRecord::Trial> trials;
    for (std::size_t k = 0; k < thetas.size(); ++k) {
      trials.push_back({ArmGuess::from(thetas[k], 1),
                        k == 6 ? ArmGuess::from(thetas[k], 1) : held,
                        {.force = 0.01 + 0.01 * static_cast<double>(k), .drift = drift}});
    }
    std::vector<double> costs(trials.size()), errors(trials.size() * kRows), alone(kRows);
    record.judge(trials, 0, costs, errors);
    for (std::size_t k = 0; k < trials.size(); ++k) {
      const ArmGains gains = record.gains(trials[k].held, trials[k].noise);
      record.innovations(trials[k].guess, gains, alone);
      double cost = gains.log_sum;
      for (std::size_t i = 0; i < kRows; ++i) {
        cost += alone[i] * alone[i];
        EXPECT_NEAR(errors[k * kRows + i], alone[i], 1e-6 * (1 + std::abs(alone[i])));
      }
      EXPECT_NEAR(costs[k], cost, 1e-9 * std::abs(cost));
    }
    std::vector<double> quick(trials.size());
    record.judge(trials, 0, quick);
    for (std::size_t k = 0; k < trials.size(); ++k) EXPECT_NEAR(quick[k], costs[k], 1e-6);
  }
}

TEST(ArmRecord, ErrorsBeyondHubersBoundCountLinearly) {
  ArmRecord::Log log = log_of(wave());
  log.x = simulated(ArmRecord(log), kHand);
  log.x[300] += 1e-3;
  const ArmRecord record(log);
  const ArmGuess guess = ArmGuess::from(kHand, 1);
  const std::vector<ArmRecord::Trial> trials{{guess, guess, {.force = 0.01}}};
  std::vector<double> plain(1), robust(1), errors(kRows);
  record.judge(trials, 0, plain, errors);
  record.judge(trials, 1.345, robust);
  double expected = plain[0];
  for (const double e : errors) {
    const double a = std::abs(e);
    if (a > 1.345) expected += 2 * 1.345 * a - 1.345 * 1.345 - a * a;
  }
  EXPECT_LT(robust[0], plain[0]);
  EXPECT_NEAR(robust[0], expected, 1e-9 * std::abs(expected));
}

TEST(ArmRecord, RenewedDerivativesAreDifferencesOfErrorsWithFiltersOfTheirOwn) {
  ArmRecord::Log log = log_of(wave());
  log.x = simulated(ArmRecord(log), kHand);
  const ArmRecord record(log);
  const ArmRecord::Noise noise{.force = 0.01, .drift = 0.1, .offset = 0.3};
  const std::vector<std::size_t> which{ArmGuess::kMass, ArmGuess::kStiffness, ArmGuess::kDelay};
  const std::vector<double> steps{1e-5, 1e-2, 1e-5};
  constexpr std::size_t kMore = 2;  // rows that stay as they are
  std::vector<double> errors(kRows), J(which.size() * (kRows + kMore), 7.0), moved(kRows);
  record.renewed(kHand, kHand, noise, which, 1, steps, errors, J, kRows + kMore);
  for (std::size_t k = 0; k < which.size(); ++k) {
    std::vector<double> at = kHand;
    at[which[k]] += steps[k];
    const ArmGuess guess = ArmGuess::from(at, 1);
    const ArmGuess held = which[k] == ArmGuess::kDelay ? ArmGuess::from(kHand, 1) : guess;
    record.innovations(guess, record.gains(held, noise), moved);
    for (std::size_t i = 0; i < kRows; ++i) {
      const double slope = (moved[i] - errors[i]) / steps[k];
      EXPECT_NEAR(J[k * (kRows + kMore) + i], slope, 1e-4 * (1 + std::abs(slope)));
    }
    EXPECT_EQ(J[k * (kRows + kMore) + kRows], 7.0);
  }
}

TEST(ArmRecord, AHandAtRestIsMovedByNoiseAlone) {
  ArmRecord::Log log = log_of(wave());
  log.x = simulated(ArmRecord(log), kHand);
  log.inputs[0].assign(kRows, 1.0);
  const ArmRecord still = ArmRecord(log).resting(std::vector<double>(kRows, 0.0));
  std::vector<double> theta = kHand;
  theta.back() = 0;
  theta[kShare] = 0.5;
  EXPECT_EQ(worst(still, theta, 0), 0.0);
  EXPECT_THROW((void)still.resting({1.0}), std::invalid_argument);
}

TEST(ArmRecord, TheInitialStateIsFreeWhateverTheDelay) {
  ArmRecord::Log log = log_of(wave());
  for (std::size_t i = 0; i < kRows; ++i) log.x[i] = 0.1 * kDt * static_cast<double>(i);
  const ArmRecord record(log);
  const ArmGains gains = record.gains(ArmGuess::from(kHand, 1), {.force = 0.01});
  std::vector<double> late = kHand;
  late[ArmGuess::kDelay] = 4e-4;
  std::vector<double> as_held(kRows), later(kRows);
  record.innovations(ArmGuess::from(kHand, 1), gains, as_held);
  record.innovations(ArmGuess::from(late, 1), gains, later);
  for (std::size_t i = 2; i < 10; ++i) EXPECT_NEAR(as_held[i], later[i], 0.5);
}

TEST(ArmRecord, TheJacobianIsTheSlopeOfTheErrors) {
  ArmRecord::Log log = log_of(wave());
  log.x = simulated(ArmRecord(log), kHand);
  const ArmRecord record(log);
  const ArmGains gains = record.gains(ArmGuess::from(kHand, 1), {.force = 0.01});
  const std::vector<std::size_t> which{0, 1, 2, 7, ArmGuess::kDelay};
  const std::vector<double> steps{1e-7, 1e-5, 1e-3, 1e-7, 1e-7};
  std::vector<double> J(which.size() * kRows);
  std::vector<double> errors(kRows);
  record.linearised(kHand, gains, which, errors, J);
  for (std::size_t k = 0; k < which.size(); ++k) {
    std::vector<double> up = kHand;
    std::vector<double> down = kHand;
    up[which[k]] += steps[k];
    down[which[k]] -= steps[k];
    std::vector<double> high(kRows);
    std::vector<double> low(kRows);
    record.innovations(ArmGuess::from(up, 1), gains, high);
    record.innovations(ArmGuess::from(down, 1), gains, low);
    for (std::size_t i = 20; i < kRows; i += 40) {
      const double slope = (high[i] - low[i]) / (2 * steps[k]);
      EXPECT_NEAR(J[k * kRows + i], slope, 1e-3 * std::abs(slope) + 1e-3) << which[k] << ' ' << i;
    }
  }
}

TEST(ArmRecord, WhatDoesNotFitIsRefused) {
  const auto refused = [](auto change) {
    ArmRecord::Log log = log_of(wave());
    change(log);
    EXPECT_THROW(ArmRecord{log}, std::invalid_argument);
  };
  refused([](auto& log) { log.force.pop_back(); });
  refused([](auto& log) { log.x[5] = std::nan(""); });
  refused([](auto& log) { log.force[5] = std::numeric_limits<double>::infinity(); });
  refused([](auto& log) { log.variance[5] = -1; });
  refused([](auto& log) { log.doubt.pop_back(); });
  refused([](auto& log) { log.inputs[0].pop_back(); });
  refused([](auto& log) { log.inputs[0][3] = std::nan(""); });
  refused([](auto& log) { log.early[3] = std::nan(""); });
  refused([](auto& log) { log.dt = 0; });
  refused([](auto& log) { log.dt = std::numeric_limits<double>::infinity(); });
  refused([](auto& log) { log.lag = -1; });
  refused([](auto& log) { log.segments = {0, 1}; });
  refused([](auto& log) {
    log.switches = {0.2, 0.1};
    log.segments = {0, 1, 0};
  });
  refused([](auto& log) {
    log.switches = {std::nan("")};
    log.segments = {0, 1};
  });
}

TEST(ArmGuess, RefusesWhatIsNoNumber) {
  const std::vector<std::string> names{"mass",  "damping", "stiffness", "delay",
                                       "onset", "bend",    "a share",   "a level"};
  for (std::size_t i = 0; i < kHand.size(); ++i) {
    for (const double wrong : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
      std::vector<double> theta = kHand;
      theta[i] = wrong;
      std::string why;
      try {
        ArmGuess::from(theta, 1);
      } catch (const std::invalid_argument& error) {
        why = error.what();
      }
      EXPECT_NE(why.find("theta[" + std::to_string(i) + "], " + names[i] + ", = "),
                std::string::npos)
          << why;
    }
  }
}

TEST(ArmRecord, ADelayBeyondTheLogHoldsItsFirstOrLastForce) {
  ArmRecord::Log log = log_of(wave());
  log.switches = {0.1};
  log.segments = {0, 0};
  const ArmRecord record(log);
  for (const double delay : {-1e300, -1e9, 1e9, 1e300}) {
    std::vector<double> theta = kHand;
    theta[kDelay] = delay;
    const ArmGuess guess = ArmGuess::from(theta, 1);
    const ArmGains gains = record.gains(guess, {.force = 0.01});
    EXPECT_EQ(gains.rows.size(), kRows);
    std::vector<double> e(kRows);
    record.innovations(guess, gains, e);
    record.simulate(guess, 0, 0, e);
  }
}

}  // namespace
}  // namespace ebac::arm_record_test
