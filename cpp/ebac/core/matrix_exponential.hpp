#pragma once

#include <Eigen/Core>

namespace ebac {

/// A square matrix of up to 12 rows, in place.
using SmallSquare = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 12, 12>;

/// exp(a), of Eigen's unsupported modules: compiled once for all sizes, with the bits of one of a fixed size. Where
/// microseconds count, a fixed size is two to five times as fast.
[[nodiscard]] SmallSquare matrix_exponential(const SmallSquare& a);

}  // namespace ebac
