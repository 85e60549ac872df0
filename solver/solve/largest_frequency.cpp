#include "solve/largest_frequency.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/dense.hpp"
#include "math/row_loops.hpp"

namespace sandglass {

namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

template <class Real>
double product(const Rows<Real>& a, const Rows<Real>& b) {
  return static_cast<double>(sum_of_products<Real>(numbers_of(a), numbers_of(b), 4 * a.size()));
}

/// Sets each number of y to change(number of x, number of y).
template <class Real, class Change>
void for_each_number(const Rows<Real>& x, Rows<Real>& y, const Change& change) {
  const Real* from = numbers_of(x);
  Real* to = numbers_of(y);
#pragma omp simd
  for (std::size_t k = 0; k < 4 * y.size(); ++k) to[k] = change(from[k], to[k]);
}

/// The largest eigenvalue of a symmetric operator, plus the residual of its vector, by Lanczos' method from a
/// start q that contains this vector (Parlett, The Symmetric Eigenvalue Problem, chapter 13). Ten steps are
/// usual.
template <class Real, class Operator>
double largest_eigenvalue(Rows<Real> q, const Operator& apply) {
  constexpr std::size_t most_steps = 40;
  constexpr double enough = 1e-3;  // of the eigenvalue
  Rows<Real> before(q.size()), next(q.size());
  std::vector<double> diagonal, beside;
  double size = std::sqrt(product(q, q));
  while (diagonal.size() < most_steps) {
    for_each_number(q, q, [length = static_cast<Real>(size)](Real, Real own) { return own / length; });
    apply(q, next);
    const auto add = [&next](double factor, const Rows<Real>& x) {
      for_each_number(x, next,
                      [f = static_cast<Real>(factor)](Real other, Real own) { return own + f * other; });
    };
    add(-size, before);
    const double share = product(next, q);
    add(-share, q);
    diagonal.push_back(share);
    size = std::sqrt(product(next, next));
    if (!std::isfinite(size)) break;
    const auto [values, vectors] = tridiagonal_eigenpairs(diagonal, beside);
    const double residual = size * std::abs(vectors.back().back());
    if (residual < enough * values.back()) return values.back() + residual;
    beside.push_back(size);
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
  constexpr double hardly = 0.02, changed = 1.1, parts = 32.0;
  constexpr int oldest = 10;
  if (square_ > 0.0) {
    double growth = 0.0, shrinkage = INFINITY;
    for (std::size_t e = 0; e < bounds.size(); ++e) {
      const double ratio = bounds[e] / bounds_[e];
      growth = std::max(growth, ratio);
      shrinkage = std::min(shrinkage, ratio);
    }
    if (growth > 1.0 + hardly || shrinkage < 1.0 - hardly) ++age_;
    if (age_ < oldest && growth < changed && std::ranges::max(bounds_) < changed * std::ranges::max(bounds))
      return growth * square_;
  }
  bounds_ = bounds;
  age_ = 0;
  const double length = diagonal(mesh.points) / std::cbrt(static_cast<double>(mesh.cells.size()));
  State<Real> moved = state;
  Rows<Real> forces(state.u.size()), change = forces;
  elements.evaluate(moved, forces);
  // In coordinates in which the mass matrix is the identity; the change of forces is the difference of two
  // evaluations.
  Rows<Real> root(state.u.size());
  for_each_number(inverse_masses, root, [](Real inverse_mass, Real) { return std::sqrt(inverse_mass); });
  const auto apply = [&](const Rows<Real>& q, Rows<Real>& image) {
    change = q;
    for_each_number(root, change, [](Real r, Real own) { return r * own; });
    const Real scale(static_cast<Real>(std::sqrt(std::numeric_limits<Real>::epsilon()) * length /
                                       static_cast<double>(largest(change))));
    ties.follow(change);
    moved.u = state.u;
    for_each_number(change, moved.u, [scale](Real other, Real own) { return own + scale * other; });
    elements.evaluate(moved, change);
    for_each_number(forces, change, [scale](Real other, Real own) { return (own - other) / scale; });
    ties.hand_on(change);
    image = change;
    for_each_number(root, image, [](Real r, Real own) { return r * own; });
  };
  // A start that contains every wavelength.
  Rows<Real> waves(root.size());
  Real* const wave = numbers_of(waves);
  const std::size_t n = 4 * waves.size();
  for (std::size_t k = 0; k < n; ++k) {
    const double x = static_cast<double>(k) / static_cast<double>(n - 1);
    if (numbers_of(root)[k] > Real(0))
      wave[k] = static_cast<Real>(std::sin(std::pow(x * static_cast<double>(n), 2)));
  }
  const double square = largest_eigenvalue(std::move(waves), apply);
  return square_ = most * std::exp2(std::ceil(parts * std::log2(square / most)) / parts);
}

template class LargestFrequency<double>;
template class LargestFrequency<float>;

}  // namespace sandglass
