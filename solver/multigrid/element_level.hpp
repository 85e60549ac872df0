#pragma once

#include <memory>

#include "assembly/row_ties.hpp"
#include "multigrid/saddle_level.hpp"

namespace sandglass {

/// The moduli of the model problem, Pa.
struct ModelModuli {
  double lambda;
  double mu;
  double hourglass;                 ///< that of PerturbationStiffness::stiffness
  bool hourglass_stiffens = false;  ///< with the law, as it is the law's and not a constant control's
};

/// An element as the levels below see it.
struct ElementTangent {
  std::array<float, 9> inverse;  ///< F^-1 by rows
  float volume;                  ///< reference volume, m^3
  float jacobian;                ///< det F
  float mu, lambda;              ///< Pa
};

/// The finest level, in single precision as all levels: every element as a one-point hexahedron in the
/// present configuration with the law's initial lambda, a shear modulus for each element and an hourglass
/// stiffness, whatever the method. Nothing is assembled. Rows are those of a layout, cells its lanes, pack by
/// pack.
class ElementLevel : public SaddleLevel {
 public:
  ElementLevel(const Layout& layout, int pressure_steps)
      : SaddleLevel({layout.row_blocks, layout.cell_blocks}, pressure_steps), layout_(layout) {}

  /// The order of its rows and cells.
  const Layout& layout() const { return layout_; }

  /// Takes the configuration with displacements u (m), in which no element may be inverted, the moduli of
  /// each material, and by cell how much stiffer than that the law has become.
  virtual void update(const Rows<float>& u, const std::vector<ModelModuli>& moduli,
                      const std::vector<float>& stiffening) = 0;

  /// The largest norm of an element's gradient of displacements u, in the present configuration.
  virtual double largest_gradient(const Rows<float>& u) const = 0;

  /// The same of the symmetric part of the gradient.
  virtual double largest_strain(const Rows<float>& u) const = 0;

  /// The cell of each element of the mesh.
  const std::vector<std::size_t>& cells() const { return cells_; }

  /// The tangents of the elements by cell, of all ranks.
  const std::vector<ElementTangent>& tangents() const { return tangents_; }

  /// The stiffness of springs that hold the rows, N/m; empty without any.
  const Rows<float>& springs() const { return springs_; }

  /// Takes the springs of contact in the configuration of the last `update`.
  void update_contact() { set_smoother(stiffness_, bound_); }

  /// The diagonal of A on constrained components too, N/m, of all ranks.
  const Rows<float>& stiffness() const { return stiffness_; }

  /// The ties of the mesh, on rows.
  const RowTies<float>& ties() const { return ties_; }

  void follow(Rows<float>& u) const override { ties_.follow(u); }

 protected:
  const Layout& layout_;
  RowTies<float> ties_;
  std::vector<std::size_t> cells_;
  std::vector<ElementTangent> tangents_;
  Rows<float> springs_;
  Rows<float> stiffness_;
  float bound_ = 1.0f;  // of the eigenvalues of the inverse of its diagonal times A
};

/// For the rows and the lanes of a layout. `free` is 1, or 0 on constrained components, tied nodes and spare
/// rows; `springs` as in ElementLevel.
std::unique_ptr<ElementLevel> make_element_level(const Mesh& mesh, const Ties& ties, const Layout& layout,
                                                 const Rows<float>& free, const Rows<float>& springs);

}  // namespace sandglass
