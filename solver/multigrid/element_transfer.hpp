#pragma once

#include "multigrid/element_level.hpp"
#include "multigrid/grid_level.hpp"

namespace sandglass {

/// Transfers problems, residuals and corrections between the elements of a mesh and the first grid around it.
/// Displacements are interpolated from the grid's; an element has the pressure of the box that contains its
/// centre.
class ElementTransfer {
 public:
  /// Both levels must live as long.
  ElementTransfer(const Mesh& mesh, const Layout& layout, const ElementLevel& elements, GridLevel& grid);

  /// Sets the problems of the boxes from the tangents of the elements. Constrained components of nodes hold
  /// the grid's functions by springs.
  void gather();

  /// Adds springs of contact to the problems of the last `gather`.
  void gather_contact();

  /// b = the residual r of the elements for the grid.
  void restrict_residual(const MixedVector& r, MixedVector& b);

  /// Adds the grid's correction x to the unknowns of the elements.
  void add_correction(const MixedVector& x, MixedVector& fine) const;

 private:
  /// A point of an element at which its box's functions are evaluated.
  struct Sample {
    std::uint32_t cell;
    float share;  // of the element's volume
    std::array<float, 3> local;
  };

  /// The contents of a box.
  struct Contents {
    std::vector<Sample> samples;
    std::vector<std::uint32_t> rows;
    std::vector<std::uint32_t> cells;
  };

  std::vector<bool> sparse_boxes(const Mesh& mesh) const;
  void sample(const Mesh& mesh, std::size_t element, float share_at_nodes);
  BoxProblem problem_of(const Contents& contents) const;
  void add_contact(const Contents& contents, BoxProblem& problem) const;

  const ElementLevel& elements_;
  GridLevel& grid_;
  std::vector<Grid::Location> places_;  // of rows
  std::vector<std::size_t> boxes_;      // of cells
  std::vector<Contents> contents_;
  std::vector<BoxProblem> without_contact_;      // empty if there has been none since `gather`
  std::vector<char> has_contact_;                // whether problems of boxes have some
  std::vector<std::array<Row<float>, 8>> sums_;  // of the corners of boxes
};

}  // namespace sandglass
