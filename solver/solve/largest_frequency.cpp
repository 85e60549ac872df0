#include "solve/largest_frequency.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace sandglass {

namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

/// The largest eigenvalue of a symmetric operator, plus the residual of its vector, by Lanczos' method from a
/// start q that contains this vector (Parlett, The Symmetric Eigenvalue Problem, chapter 13). Ten steps are
/// usual.
template <class Numbers, class Operator>
double largest_eigenvalue(Numbers q, const Operator& apply) {
  constexpr Eigen::Index most_steps = 40;
  constexpr double enough = 1e-3;  // of the eigenvalue
  Numbers before = Numbers::Zero(q.size());
  Eigen::VectorXd diagonal(most_steps), beside(most_steps + 1);
  beside[0] = static_cast<double>(q.norm());
  for (Eigen::Index k = 0; k < most_steps; ++k) {
    using Real = typename Numbers::Scalar;
    q /= static_cast<Real>(beside[k]);
    Numbers next = apply(q);
    if (k > 0) next -= static_cast<Real>(beside[k]) * before;
    const Real share = next.dot(q);
    next -= share * q;
    diagonal[k] = static_cast<double>(share);
    beside[k + 1] = static_cast<double>(next.norm());
    if (!std::isfinite(beside[k + 1])) break;
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> small;
    small.computeFromTridiagonal(diagonal.head(k + 1), beside.segment(1, k));
    const double value = small.eigenvalues()[k];
    const double residual = beside[k + 1] * std::abs(small.eigenvectors()(k, k));
    if (residual < enough * value) return value + residual;
    before.swap(q);
    q.swap(next);
  }
  return unknown;
}

}  // namespace

template <class Real>
double LargestFrequency<Real>::square(const Mesh& mesh, const ElementForces<Real>& elements,
                                      const RowTies<Real>& ties, const Rows<Real>& inverse_masses,
                                      const State<Real>& state, const std::vector<double>& bounds,
                                      double most) {
  if (elements.needs_increment() || !state.history.empty()) return unknown;
  using Numbers = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  constexpr double hardly = 0.02, changed = 1.1, parts = 32.0;
  constexpr int oldest = 10;
  if (square_ > 0.0) {
    const auto now = Eigen::ArrayXd::Map(bounds.data(), static_cast<Eigen::Index>(bounds.size()));
    const auto before = Eigen::ArrayXd::Map(bounds_.data(), now.size());
    const Eigen::ArrayXd ratios = now / before;
    const double growth = ratios.maxCoeff();
    if (growth > 1.0 + hardly || ratios.minCoeff() < 1.0 - hardly) ++age_;
    if (age_ < oldest && growth < changed && before.maxCoeff() < changed * now.maxCoeff())
      return growth * square_;
  }
  bounds_ = bounds;
  age_ = 0;
  const auto numbers = [](auto& rows) {
    return Numbers::Map(numbers_of(rows), 4 * static_cast<Eigen::Index>(rows.size()));
  };
  const double length = diagonal(mesh.points) / std::cbrt(static_cast<double>(mesh.cells.size()));
  State<Real> moved = state;
  Rows<Real> forces(state.u.size()), change = forces;
  elements.evaluate(moved, forces);
  // In coordinates in which the mass matrix is the identity; the change of forces is the difference of two
  // evaluations.
  const Numbers root = numbers(inverse_masses).cwiseSqrt();
  const auto apply = [&](const Numbers& q) -> Numbers {
    numbers(change) = root.cwiseProduct(q);
    const double largest = static_cast<double>(numbers(change).cwiseAbs().maxCoeff());
    const Real scale(static_cast<Real>(std::sqrt(std::numeric_limits<Real>::epsilon()) * length / largest));
    ties.follow(change);
    numbers(moved.u) = numbers(state.u) + scale * numbers(change);
    elements.evaluate(moved, change);
    numbers(change) = (numbers(change) - numbers(forces)) / scale;
    ties.hand_on(change);
    return root.cwiseProduct(numbers(change));
  };
  // A start that contains every wavelength.
  const Numbers waves = Numbers::LinSpaced(root.size(), Real(0), Real(1)).unaryExpr([&](Real x) {
    return static_cast<Real>(
        std::sin(std::pow(static_cast<double>(x) * static_cast<double>(root.size()), 2)));
  });
  const double square = largest_eigenvalue<Numbers>((root.array() > Real(0)).select(waves, Real(0)), apply);
  return square_ = most * std::exp2(std::ceil(parts * std::log2(square / most)) / parts);
}

template class LargestFrequency<double>;
template class LargestFrequency<float>;

}  // namespace sandglass
