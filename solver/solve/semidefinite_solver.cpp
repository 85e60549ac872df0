#include "solve/semidefinite_solver.hpp"

#include <Eigen/Dense>

namespace sandglass {

struct SemidefiniteSolver::Factor {
  Eigen::VectorXd scale;
  Eigen::LDLT<Eigen::MatrixXd> ldlt;
  Eigen::VectorXd inverse_pivots;
  Eigen::VectorXd x;
};

SemidefiniteSolver::SemidefiniteSolver(std::size_t size) : factor_(std::make_unique<Factor>()) {
  const auto n = static_cast<Eigen::Index>(size);
  *factor_ = {Eigen::VectorXd(n), Eigen::LDLT<Eigen::MatrixXd>(n), Eigen::VectorXd(n), Eigen::VectorXd(n)};
}

SemidefiniteSolver::~SemidefiniteSolver() = default;

void SemidefiniteSolver::factorise(const std::vector<double>& A) {
  auto& [scale, ldlt, inverse_pivots, x] = *factor_;
  const Eigen::Map<const Eigen::MatrixXd> matrix(A.data(), scale.size(), scale.size());
  const auto diagonal = matrix.diagonal().array();
  scale = (diagonal > smallest_diagonal * diagonal.maxCoeff()).select(diagonal.sqrt().inverse(), 0.0);
  ldlt.compute(scale.asDiagonal() * matrix * scale.asDiagonal());
  const auto pivots = ldlt.vectorD().array();
  inverse_pivots = (pivots > smallest_pivot).select(pivots.inverse(), 0.0);
}

void SemidefiniteSolver::solve(std::span<const double> b, std::span<double> result) {
  auto& [scale, ldlt, inverse_pivots, x] = *factor_;
  x = scale.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(b.data(), scale.size()));
  x = ldlt.transpositionsP() * x;
  ldlt.matrixL().solveInPlace(x);
  x.array() *= inverse_pivots.array();
  ldlt.matrixU().solveInPlace(x);
  x = ldlt.transpositionsP().transpose() * x;
  Eigen::Map<Eigen::VectorXd>(result.data(), scale.size()) = scale.cwiseProduct(x);
}

}  // namespace sandglass
