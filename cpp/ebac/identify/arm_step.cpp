#include "ebac/identify/arm_step.hpp"

#include "ebac/core/matrix_exponential.hpp"

namespace ebac {

ArmStep::ArmStep(const ArmGuess& guess, double dt)
    : per_mass(1 / guess.mass), stiffness(guess.stiffness) {
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  a(0, 1) = dt;
  a(1, 0) = -guess.stiffness * per_mass * dt;
  a(1, 1) = -guess.damping * per_mass * dt;
  a(1, 2) = dt;
  a(2, 3) = 1;
  const Eigen::Matrix4d flow = matrix_exponential(a);
  phi = flow.topLeftCorner<2, 2>();
  start = flow.topRows<2>().col(2);
  change = flow.topRows<2>().col(3);
}

}  // namespace ebac
