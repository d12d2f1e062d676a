#include "ebac/core/matrix_exponential.hpp"

#include <unsupported/Eigen/MatrixFunctions>

namespace ebac {

SmallSquare matrix_exponential(const SmallSquare& a) { return a.exp(); }

}  // namespace ebac
