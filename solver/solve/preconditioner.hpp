#pragma once

#include "solve/body.hpp"
#include "solve/coarse_stiffness.hpp"

namespace sandglass {

/// An approximate inverse of the tangent stiffness, the sum of two parts: the inverse of a 3 x 3 block at
/// each node, and a coarse grid of trilinear displacements over the bounding box, whose few equations are
/// solved exactly. The blocks account for differences between nodes, the grid for soft motions of the whole
/// body, for which nodal iterations converge slowly. Both are built from the mean gradients of the elements
/// at the displacements of the last update, with the law's initial moduli; hourglass stiffness enters the
/// blocks through the elements' stiffness bounds. Symmetric and positive semidefinite; constrained components
/// are zero.
template <class Real>
class Preconditioner {
 public:
  /// For a body of the model; `update` must follow.
  Preconditioner(const Model& model, const InternalForce<Real>& elements, const Body<Real>& body);

  /// Recomputes both parts at a body's displacements; none of its elements may be inverted.
  void update(Body<Real>& body);

  /// The size of coarse vectors: three numbers per grid node.
  std::size_t coarse_size() const { return stiffness_.size(); }

  /// q = Z^T r, r on the rows and q on the coarse grid. Constrained components of r must be zero.
  void restrict_to_coarse(const Rows<Real>& r, CoarseVector& q, int threads) {
    transfer_.restrict_to_coarse(r, q, threads);
  }

  /// c = A^-1 q.
  void solve(const CoarseVector& q, CoarseVector& c) { stiffness_.solve(q, c); }

  /// Sets the coarse vector c for `from_coarse`.
  void take(const CoarseVector& c) { transfer_.take(c); }

  /// B r for the rows from number k on.
  template <int W>
  RowVector<Real, W> nodal(std::size_t k, const RowVector<Real, W>& r) const {
    return symmetric_product<W>(load<W>(numbers_of(diagonal_) + k), load<W>(numbers_of(mixed_) + k), r);
  }

  /// Z c for the rows from number k on; zero on constrained components, whose blocks are zero.
  template <int W>
  RowVector<Real, W> from_coarse(std::size_t k) const {
    const auto diagonal = load<W>(numbers_of(diagonal_) + k);
    const RowVector<Real, W> nothing{};
    return diagonal > nothing ? transfer_.template from_coarse<W>(k) : nothing;
  }

 private:
  template <class Number>
  void add_elements(const Body<Real>& body, const std::vector<double>& bounds);
  template <class Number>
  void add_chunk(const Layout::Chunk& chunk, const Body<Real>& body, const std::vector<double>& bounds);
  void invert_blocks(int threads);
  ElementTangent tangent_of(std::size_t element) const;

  const Layout& layout_;
  double lambda_;
  double mu_;
  Rows<Real> coordinates_;                     // m
  Rows<Real> free_;                            // 1, or 0 on constrained components and in spare rows
  Rows<Real> diagonal_;                        // xx, yy, zz of the inverse blocks
  Rows<Real> mixed_;                           // yz, zx, xy
  std::vector<Real> tangents_;                 // [rank][F^-1 by rows, V][lane]
  std::vector<std::size_t> place_of_element_;  // into tangents_
  CoarseTransfer<Real> transfer_;
  CoarseStiffness stiffness_;
};

extern template class Preconditioner<double>;
extern template class Preconditioner<float>;

}  // namespace sandglass
