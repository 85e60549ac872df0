#pragma once

#include "problem/model.hpp"
#include "solve/coarse_grid.hpp"
#include "solve/coarse_transfer.hpp"
#include "solve/semidefinite_solver.hpp"

namespace sandglass {

/// The deformation of one element as the coarse stiffness sees it.
struct ElementTangent {
  Tensor<double> inverse;  ///< F^-1
  double volume;           ///< reference volume, m^3
};

/// The tangent stiffness on a coarse grid, factorised, by the law's moduli at rest (N/m). Elements that
/// are free and small see the gradients of the grid's functions at their centre, pushed forward with their
/// own deformation. Elements that touch a constraint, or are no smaller than the boxes of the grid, see the
/// functions as their nodes take them, exactly, but stay as they are at rest.
class CoarseStiffness {
 public:
  CoarseStiffness(const Scene& scene, const CoarseGrid& grid);

  std::size_t size() const { return size_; }

  /// Takes the tangent at a deformation and factorises it. `tangent_of(e)` gives the ElementTangent of
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
    solver_.factorise(matrix_);
  }

  /// c = A^-1 q. What a function adds that only moves constrained nodes is zero.
  void solve(const CoarseVector& q, CoarseVector& c) { solver_.solve(q, c); }

 private:
  /// Sums of V G_ai G_bj over the elements of a box, G_a the gradients of its eight functions.
  using Products = std::array<double, std::size_t{24} * 24>;

  struct Element {
    std::size_t index;
    std::array<double, 3> local;  ///< where its centre lies
  };
  struct Box {
    std::array<std::size_t, 8> nodes;
    std::vector<Element> elements;  ///< free and small, by their centres
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
  std::vector<double> fixed_;   // what does not follow the deformation
  std::vector<double> matrix_;  // A, by rows
  SemidefiniteSolver solver_;
};

}  // namespace sandglass
