// GCC 12 warns of its own AVX-512 headers when Eigen uses them; these matrices are too small to need them.
#define EIGEN_DONT_VECTORIZE

#include "support/eigenvalues.hpp"

#include <Eigen/Eigenvalues>

namespace sandglass::verification {

std::vector<double> symmetric_eigenvalues(const double* entries, int size) {
  const Eigen::MatrixXd matrix = Eigen::Map<const Eigen::MatrixXd>(entries, size, size);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
  const Eigen::VectorXd values = solver.eigenvalues();
  return {values.begin(), values.end()};
}

}  // namespace sandglass::verification
