#include "solve/semidefinite_solver.hpp"

#include <Eigen/Dense>

namespace sandglass {

struct SemidefiniteSolver::Factor {
  Eigen::VectorXd scale;
  Eigen::LLT<Eigen::MatrixXd> llt;
  Eigen::VectorXd x;
};

SemidefiniteSolver::SemidefiniteSolver(std::size_t size) : factor_(std::make_unique<Factor>()) {
  const auto n = static_cast<Eigen::Index>(size);
  *factor_ = {Eigen::VectorXd(n), Eigen::LLT<Eigen::MatrixXd>(n), Eigen::VectorXd(n)};
}

SemidefiniteSolver::~SemidefiniteSolver() = default;

void SemidefiniteSolver::factorise(const std::vector<double>& A) {
  auto& [scale, llt, x] = *factor_;
  const Eigen::Map<const Eigen::MatrixXd> matrix(A.data(), scale.size(), scale.size());
  const auto diagonal = matrix.diagonal().array();
  scale = (diagonal > 1e-8 * diagonal.maxCoeff()).select(diagonal.sqrt().inverse(), 0.0);
  Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  scaled.diagonal().setConstant(1.0 + shift);
  llt.compute(scaled);
}

void SemidefiniteSolver::solve(std::span<const double> b, std::span<double> result) {
  auto& [scale, llt, x] = *factor_;
  x = scale.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(b.data(), scale.size()));
  llt.solveInPlace(x);
  Eigen::Map<Eigen::VectorXd>(result.data(), scale.size()) = scale.cwiseProduct(x);
}

}  // namespace sandglass
