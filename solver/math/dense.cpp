#include "math/dense.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace sandglass {

namespace {

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

auto numbers(std::span<const double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Eigenpairs pairs_of(const Solver& solver) {
  Eigenpairs pairs{{solver.eigenvalues().begin(), solver.eigenvalues().end()}, {}};
  for (const auto& vector : solver.eigenvectors().colwise())
    pairs.vectors.emplace_back(vector.begin(), vector.end());
  return pairs;
}

}  // namespace

Eigenpairs symmetric_eigenpairs(std::span<const double> entries) {
  const auto n = static_cast<Eigen::Index>(std::lround(std::sqrt(static_cast<double>(entries.size()))));
  return pairs_of(Solver(Eigen::Map<const Rows>(entries.data(), n, n)));
}

Eigenpairs tridiagonal_eigenpairs(std::span<const double> diagonal, std::span<const double> beside) {
  Solver solver;
  solver.computeFromTridiagonal(numbers(diagonal), numbers(beside));
  return pairs_of(solver);
}

std::vector<double> solve_positive_definite(std::span<const double> entries, std::vector<double> b) {
  const auto n = static_cast<Eigen::Index>(b.size());
  Eigen::Map<Eigen::VectorXd> x(b.data(), n);
  Eigen::Map<const Rows>(entries.data(), n, n).llt().solveInPlace(x);
  return b;
}

}  // namespace sandglass
