#include "ebac/sim/linear_loop.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "ebac/model/exact_plant.hpp"

namespace ebac {

namespace {

enum Index { kX, kV, kMotor, kLastX, kEstimate, kCommands };

void require_linear(const DeviceModel& device) {
  if (!LinearLoop::covers(device)) {
    throw std::invalid_argument(
        "the linear loop needs straight axes without cable compliance and backlash, "
        "BackwardDifference or LowPass as velocity estimate, and no compensation of friction or "
        "inertia; simulate this device instead");
  }
}

/// Share of the new difference in the estimate, as in VelocityState::update.
double smoothing(const Velocity& estimator, double tick) {
  const auto* low_pass = std::get_if<LowPass>(&estimator);
  return low_pass != nullptr ? tick / (low_pass->time_constant + tick) : 1.0;
}

/// Those of the block of two rows at (i, i) of a real Schur form.
std::array<std::complex<double>, 2> pair_of(const Eigen::MatrixXd& t, Eigen::Index i) {
  const double half = 0.5 * (t(i, i) - t(i + 1, i + 1));
  const double below = t(i + 1, i);
  const double above = t(i, i + 1);
  const double most = std::max(std::abs(half), std::max(std::abs(below), std::abs(above)));
  const double share = half / most;  // so that no square overflows
  const double height = most * std::sqrt(std::abs(share * share + below / most * (above / most)));
  const double middle = t(i + 1, i + 1) + half;
  return {std::complex(middle, height), std::complex(middle, -height)};
}

/// The eigenvalues from the real Schur form. `Eigen::EigenSolver` takes the same steps, to the bit,
/// but brings the eigenvectors, which take most of the time to compile.
std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& matrix) {
  const double scale = matrix.cwiseAbs().maxCoeff();
  const Eigen::HessenbergDecomposition<Eigen::MatrixXd> reduced(matrix / scale);
  Eigen::RealSchur<Eigen::MatrixXd> schur(matrix.rows());
  schur.computeFromHessenberg(reduced.matrixH(), Eigen::MatrixXd(), /*computeU=*/false);
  const Eigen::MatrixXd t = schur.matrixT() * scale;
  std::vector<std::complex<double>> found;
  for (Eigen::Index i = 0; i < t.rows();) {
    if (i == t.rows() - 1 || t(i + 1, i) == 0) {
      found.emplace_back(t(i, i));
      i += 1;
    } else {
      const auto pair = pair_of(t, i);
      found.insert(found.end(), pair.begin(), pair.end());
      i += 2;
    }
  }
  return found;
}

}  // namespace

bool LinearLoop::covers(const DeviceModel& device) {
  const bool straight = std::holds_alternative<Linear>(device.kinematics);
  const bool estimated = !std::holds_alternative<AdaptiveWindow>(device.velocity);
  const bool helped = device.compensation.friction > 0 || device.compensation.inertia > 0;
  return straight && !device.mechanics.compliant() && estimated && !helped;
}

LinearLoop::LinearLoop(const Setup& setup)
    : size_(kCommands + setup.timing.delay),
      delay_(setup.timing.delay),
      tick_(setup.timing.dt),
      smoothing_(smoothing(setup.device.velocity, setup.timing.dt)) {
  require_linear(setup.device);
  if (!setup.hand.linear()) {
    throw std::invalid_argument("LinearLoop: needs a hand without a model, eq. (4)");
  }
  AxisParameters parameters = axis_parameters(setup.device, setup.hand);
  parameters.coulomb = 0;
  const ExactAxis axis(parameters, tick_);
  const auto& phi = axis.sliding().level(0).phi;
  own_ = phi.block<2, 2>(0, ExactAxis::kXi);
  late_ = phi.col(ExactAxis::kPhi).head<2>();
  held_ = phi.col(ExactAxis::kF).head<2>();
  hold_ = parameters.current_lag > 0 ? phi(ExactAxis::kPhi, ExactAxis::kPhi) : 0.0;
  if (parameters.current_lag == 0) late_.setZero();
}

LinearLoop::Row LinearLoop::velocity_row() const {
  Row row = Row::Zero(size_);
  row[kX] = smoothing_ / tick_;
  row[kLastX] = -smoothing_ / tick_;
  row[kEstimate] = 1 - smoothing_;
  return row;
}

Eigen::MatrixXd LinearLoop::matrix(double stiffness, double damping) const {
  const Row estimate = velocity_row();
  Row command = damping * estimate;
  command[kX] += stiffness;
  const Row u = delay_ == 0 ? command : Row(Row::Unit(size_, size_ - 1));

  Eigen::MatrixXd next = Eigen::MatrixXd::Zero(size_, size_);
  next.topLeftCorner<2, 2>() = own_;
  next.block<2, 1>(0, kMotor) = late_;
  next.topRows<2>() += (held_ - late_) * u;
  next(kMotor, kMotor) = hold_;
  next.row(kMotor) += (1 - hold_) * u;
  next(kLastX, kX) = 1;
  next.row(kEstimate) = estimate;
  if (delay_ > 0) next.row(kCommands) = command;
  for (Eigen::Index i = kCommands + 1; i < size_; ++i) next(i, i - 1) = 1;
  return next;
}

std::vector<std::complex<double>> LinearLoop::eigenvalues(double stiffness, double damping) const {
  return eigenvalues_of(matrix(stiffness, damping));
}

double LinearLoop::spectral_radius(double stiffness, double damping) const {
  double largest = 0;
  for (const auto& value : eigenvalues(stiffness, damping)) {
    largest = std::max(largest, std::abs(value));
  }
  return largest;
}

double LinearLoop::stiffness_limit(double damping) const {
  constexpr double kStep = 1.05;    // of the ladder that brackets the first instability
  constexpr double kSharp = 1e-10;  // relative width at which the bisection stops
  const auto stable = [&](double k) { return spectral_radius(k, damping) < 1; };
  if (!stable(kLeastStiffness)) return 0;
  double low = kLeastStiffness;
  double high = low * kStep;
  while (high < kMostStiffness && stable(high)) {
    low = high;
    high *= kStep;
  }
  if (high >= kMostStiffness) return kMostStiffness;
  while (high - low > kSharp * high) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace ebac
