#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "ebac/core/realtime.hpp"

namespace ebac {

/// Time inside the plant is counted in quanta: a tick has 2^20 of them, about a nanosecond at 1
/// kHz. An event is found to the quantum; a jittered tick is a whole number of them.
inline constexpr int kQuantaBits = 20;
inline constexpr std::int64_t kQuanta = std::int64_t{1} << kQuantaBits;

/// The exact flow of w' = A w over dyadic parts of a tick, and the exact integral of (row . w)^2
/// along it. The last rows of A are zero: these entries of w are constant inputs.
///
/// Level j moves by 2^-j ticks: w <- (phi w, inputs), and the integral is w^T square w (Van Loan
/// 1978). Everything is computed once per parameter set, by the matrix exponential.
class LinearFlow {
 public:
  static constexpr int kSize = 6;
  static constexpr int kMoving = 4;  // entries before the inputs
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  struct Step {
    Eigen::Matrix<double, kMoving, kSize> phi;
    Matrix square;

    Vector from(const Vector& w) const EBAC_RT {
      Vector next;
      next.head<kMoving>().noalias() = phi * w;
      next.tail<kSize - kMoving>() << w[kMoving], w[kMoving + 1];
      return next;
    }

    /// The integral, in two sums whatever the width of the processor's vectors.
    double along(const Vector& w) const EBAC_RT {
      const Vector s = square * w;
      const double even = w[0] * s[0] + (w[2] * s[2] + w[4] * s[4]);
      const double odd = w[1] * s[1] + (w[3] * s[3] + w[5] * s[5]);
      return even + odd;
    }
  };

  LinearFlow(const Matrix& a, const Vector& row, double tick);

  const Step& level(int j) const EBAC_RT { return levels_[static_cast<std::size_t>(j)]; }

 private:
  std::array<Step, kQuantaBits + 1> levels_;
};

}  // namespace ebac
