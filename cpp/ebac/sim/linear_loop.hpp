#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "ebac/sim/setup.hpp"

namespace ebac {

/// One axis held in a virtual spring and damper without a law: hand, handle, current lag, delay,
/// velocity estimate and hold, exactly as simulated but without friction, encoder counts, the
/// wall's edge and the drive's peak. The remaining loop is linear, so its stability follows from
/// its eigenvalues.
///
/// The state at tick k: x, v, f_motor, the last x, the estimated v, and the commands in flight.
class LinearLoop {
 public:
  /// The axis of `setup`; its environment is not looked at. Throws std::invalid_argument for a
  /// device that is not linear even so.
  explicit LinearLoop(const Setup& setup);

  /// Whether a device is linear deep in a wall: friction and counts apart, which the loop leaves out.
  static bool covers(const DeviceModel& device);

  /// The state of the next tick is this times the state; stiffness [N/m], damping [N s/m] of the
  /// wall.
  Eigen::MatrixXd matrix(double stiffness, double damping) const;

  std::vector<std::complex<double>> eigenvalues(double stiffness, double damping) const;

  /// Largest modulus of an eigenvalue: below one, everything decays.
  double spectral_radius(double stiffness, double damping) const;

  /// Largest stiffness [N/m] up to which the spectral radius stays below one; 0 where the wall's
  /// damping alone is too much, `kMostStiffness` where nothing is.
  double stiffness_limit(double damping) const;

  static constexpr double kLeastStiffness = 1;   // N/m, where the search begins
  static constexpr double kMostStiffness = 1e7;  // N/m, where it ends: the range of a wall

 private:
  using Row = Eigen::RowVectorXd;

  Row velocity_row() const;

  Eigen::Index size_;                // of the state
  Eigen::Index delay_;               // samples
  double tick_;                      // s
  double smoothing_;                 // share of the new difference in the estimated velocity
  double hold_;                      // of the current loop over a tick; 0 without lag
  Eigen::Matrix<double, 2, 2> own_;  // x, v after a tick, of x, v before
  Eigen::Vector2d late_;             // of f_motor - u
  Eigen::Vector2d held_;             // of u
};

}  // namespace ebac
