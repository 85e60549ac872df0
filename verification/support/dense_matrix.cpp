#include "support/dense_matrix.hpp"

#include <Eigen/LU>
#include <cmath>

namespace sandglass::verification {

double largest_eigenvalue_magnitude(const double* entries, int size) {
  // Gelfand's formula, the limit of |A^m|^(1/m), m = 2, 4, 8, ...: the norm exceeds the radius by a factor
  // that depends on the size and the eigenvectors' angles, of which the m-th root is taken. (The QR iteration
  // does not converge for some tangents of symmetric elements.) Rows serve as columns: a matrix and its
  // transpose have the same eigenvalues.
  Eigen::MatrixXd power = Eigen::Map<const Eigen::MatrixXd>(entries, size, size);
  double log_radius = 0.0, root = 1.0;
  for (int squared = 0; squared < 34; ++squared, root *= 0.5) {
    const double norm = power.norm();
    log_radius += root * std::log(norm);
    power /= norm;
    power = (power * power).eval();
  }
  return std::exp(log_radius);
}

std::function<std::vector<double>(const std::vector<double>&)> factored(const double* entries, int size) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return [solver = Eigen::PartialPivLU<Eigen::MatrixXd>(Eigen::Map<const Rows>(entries, size, size)),
          size](const std::vector<double>& b) {
    const Eigen::VectorXd x = solver.solve(Eigen::Map<const Eigen::VectorXd>(b.data(), size));
    return std::vector<double>(x.begin(), x.end());
  };
}

}  // namespace sandglass::verification
