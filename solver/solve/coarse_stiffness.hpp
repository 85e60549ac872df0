#pragma once

#include "problem/model.hpp"
#include "solve/coarse_grid.hpp"
#include "solve/coarse_transfer.hpp"
#include "solve/semidefinite_inverse.hpp"

namespace sandglass {

/// The deformation of one element as the coarse stiffness uses it.
struct ElementTangent {
  Tensor<double> inverse;  ///< F^-1
  double volume;           ///< reference volume, m^3
};

/// The inverse tangent stiffness (N/m) on a coarse grid, with the law's initial moduli. Free and small
/// elements use the gradients of the grid's functions at their centre, pushed forward with their own
/// deformation. Elements that touch a constraint, or are not smaller than boxes of the grid, use the exact
/// nodal values of the functions, but in the undeformed state.
class CoarseStiffness {
 public:
  /// Sorts the elements of a scene into the boxes of the grid; `update` must follow.
  CoarseStiffness(const Scene& scene, const CoarseGrid& grid);

  std::size_t size() const { return size_; }

  /// Assembles and inverts the tangent at a deformation, where `tangent_of(e)` is the ElementTangent of
  /// element e.
  template <class TangentOf>
  void update(const TangentOf& tangent_of, int threads) {
    in_parallel(boxes_.size(), threads, [&](std::size_t c) {
      Products& T = boxes_[c].products;
      T.fill(0.0);
      for (const auto& [element, local] : boxes_[c].elements)
        add_element(T, grid_.gradients(local), tangent_of(element));
    });
    assemble();
    inverse_.invert(matrix_);
  }

  /// c = A^-1 q; zero for functions that move only constrained nodes.
  void solve(const CoarseVector& q, CoarseVector& c) const { inverse_.solve(q, c); }

 private:
  /// Sums of V G_ai G_bj over the elements of a box, G_a the gradients of its eight functions.
  using Products = std::array<double, std::size_t{24} * 24>;

  struct Element {
    std::size_t index;
    std::array<double, 3> local;  ///< place of its centre in the box
  };
  struct Box {
    std::array<std::size_t, 8> nodes;
    std::vector<Element> elements;  ///< free and small ones with their centre in the box
    Products products;
  };

  static void add_element(Products& T, const std::array<Vector, 8>& reference, const ElementTangent& tangent);
  void add_fixed_element(const Scene& scene, const Hexahedron& cell, const NodalField& free);
  void assemble();

  double& entry(std::size_t row, std::size_t column) { return matrix_[row * size_ + column]; }

  CoarseGrid grid_;
  std::size_t size_;
  double lambda_;
  double mu_;
  std::vector<Box> boxes_;
  std::vector<double> fixed_;   // part of A that does not follow the deformation
  std::vector<double> matrix_;  // A, by rows
  SemidefiniteInverse inverse_;
};

}  // namespace sandglass
