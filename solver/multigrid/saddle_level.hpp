#pragma once

#include <functional>
#include <vector>

#include "math/matrix.hpp"
#include "math/spring.hpp"
#include "multigrid/mixed_vector.hpp"

namespace sandglass {

/// L with L L^T = K, lower triangular, of a symmetric K without negative eigenvalues. Pivots are at least
/// 1e-6 of the diagonal: less is rounding.
Tensor<float> cholesky(const Tensor<float>& K);

/// One level of a multigrid method for the saddle-point problem of a nearly incompressible body,
///   A u + B^T p = f,   B u - C p = g,
/// where A is the stiffness without volume changes, B their derivative (m^2), and C the diagonal of volumes
/// over lambda (m^3/Pa). Because both unknowns are solved together, no step suffers from a large lambda.
class SaddleLevel {
 public:
  /// `blocks` of its vectors; the smoother takes this number of pressure steps.
  SaddleLevel(MixedBlocks blocks, int pressure_steps)
      : blocks_(std::move(blocks)), pressure_steps_(pressure_steps) {}
  SaddleLevel(const SaddleLevel&) = delete;
  SaddleLevel& operator=(const SaddleLevel&) = delete;
  virtual ~SaddleLevel() = default;

  /// A vector of this level, zero.
  MixedVector zero() const { return {Rows<float>(free_.size()), std::vector<float>(compliance_.size())}; }

  /// y = (A u + B^T p, B u - C p).
  virtual void apply(const MixedVector& x, MixedVector& y) const = 0;

  /// g = B u.
  virtual void divergence(const Rows<float>& u, std::vector<float>& g) const = 0;

  /// f = B^T p.
  virtual void gradient(const std::vector<float>& p, Rows<float>& f) const = 0;

  /// Sets tied values from the values that they follow.
  virtual void follow(Rows<float>& /*u*/) const {}

  /// One step of the smoother from x: an inexact Uzawa step, symmetric, after Braess and Sarazin 1997.
  /// Displacements relax with D, pressures with Chebyshev steps on S = B D B^T + C, and the displacements
  /// follow the pressures.
  void smooth(const MixedVector& b, MixedVector& x);

  /// The same from zero; the value of x is ignored.
  void smooth_from_zero(const MixedVector& b, MixedVector& x);

  /// r = b - (A u + B^T p, B u - C p), zero on constrained components.
  void residual(const MixedVector& b, const MixedVector& x, MixedVector& r) const;

  /// A row's block of D (m/N): the diagonal of A, inverted and scaled such that D A has eigenvalues below 2;
  /// zero on constrained components. Springs of contact are part of it: with their stiffness K, D becomes the
  /// inverse of D^-1 + K, scaled as D.
  Tensor<float> relaxation(std::size_t row) const;

  /// Sets the springs of contact, by row; an update must follow.
  void set_contact(const std::vector<Spring>& springs);

  /// Adds a share of D f (m), f in N, to displacements u (m).
  void relax(float share, const Rows<float>& f, Rows<float>& u) const;

  /// A row with springs of contact.
  struct Touching {
    std::size_t row;
    Tensor<float> ground;     // stiffness of those to the ground, N/m
    Tensor<float> stiffness;  // an upper bound of that of all, N/m
    Tensor<float> change;     // what they add to D, m/N
  };

  /// These rows, in the order of the springs.
  const std::vector<Touching>& touching() const { return touching_; }

  /// That of a row; null if there is none.
  const Touching* touching_at(std::size_t row) const {
    const int place = place_of_row_.empty() ? -1 : place_of_row_[row];
    return place < 0 ? nullptr : &touching_[static_cast<std::size_t>(place)];
  }

  /// The diagonal of D (m/N) without springs of contact.
  const Rows<float>& diagonal() const { return diagonal_; }

  /// 1, or 0 on constrained components and unused rows.
  const Rows<float>& free() const { return free_; }

  /// The blocks of its vectors.
  const MixedBlocks& blocks() const { return blocks_; }

 protected:
  /// Calls visit(cell, row, b) for every cell and each of its corners, with the column b (m^2) of B.
  using VisitCorner = std::function<void(std::size_t cell, std::size_t row, const std::array<float, 3>& b)>;
  virtual void for_each_corner(const VisitCorner& visit) const = 0;

  void resize(std::size_t rows, std::size_t cells);

  /// Sets the smoother from the diagonal of A (N/m), without springs of contact, and a bound of the
  /// eigenvalues of its inverse times A.
  void set_smoother(const Rows<float>& diagonal, float bound);

  MixedBlocks blocks_;
  Rows<float> free_;
  std::vector<float> compliance_;  // C
  std::vector<Spring> contact_;    // springs of contact
  std::vector<Touching> touching_;
  std::vector<int> place_of_row_;  // in these, or -1

 private:
  void relax_pressures(const MixedVector& b, MixedVector& x);

  int pressure_steps_;
  Rows<float> diagonal_;      // of D without springs of contact
  std::vector<float> schur_;  // the inverse of the diagonal of S, scaled such that its product with S has
                              // eigenvalues up to 1
  MixedVector y_;             // scratch
  Rows<float> t_;
  std::vector<float> r_, change_, sum_;
  Rows<float> touching_forces_;  // scratch
};

}  // namespace sandglass
