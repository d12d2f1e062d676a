#include "ebac/model/linear_flow.hpp"

#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "ebac/core/matrix_exponential.hpp"

namespace ebac {

LinearFlow::LinearFlow(const Matrix& a, const Vector& row, double tick) {
  // Van Loan: exp([[-A^T, Q], [0, A]] h) = [[*, G], [0, F]] gives phi = F and int phi^T Q phi = F^T
  // G. The exponential of the smallest step is free of cancellation; doubling builds the others.
  Eigen::Matrix<double, 2 * kSize, 2 * kSize> block;
  block.setZero();
  block.topLeftCorner<kSize, kSize>() = -a.transpose();
  block.topRightCorner<kSize, kSize>() = row * row.transpose();
  block.bottomRightCorner<kSize, kSize>() = a;
  const Eigen::Matrix<double, 2 * kSize, 2 * kSize> tiny =
      matrix_exponential(block * std::ldexp(tick, -kQuantaBits));

  Matrix square =
      tiny.bottomRightCorner<kSize, kSize>().transpose() * tiny.topRightCorner<kSize, kSize>();
  Matrix half;
  for (int j = kQuantaBits; j >= 0; --j) {
    if (j < kQuantaBits) square = (square + half.transpose() * square * half).eval();
    const Matrix phi = (a * std::ldexp(tick, -j)).exp();
    levels_[static_cast<std::size_t>(j)] = {phi.topRows<kMoving>(),
                                            0.5 * (square + square.transpose())};
    half = phi;
  }
}

}  // namespace ebac
