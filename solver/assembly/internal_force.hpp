#pragma once

#include <memory>
#include <span>
#include <variant>

#include "assembly/layout.hpp"
#include "assembly/state.hpp"
#include "element/method_choice.hpp"
#include "material/materials.hpp"

namespace sandglass {

/// What moves a body: displacements in, internal forces out. Behind this interface, which hides the choice
/// made at run time, loops are monomorphic. All functions are const, so that threads may share an object.
template <class Real>
class ElementForces {
 public:
  ElementForces() = default;
  ElementForces(const ElementForces&) = delete;
  ElementForces& operator=(const ElementForces&) = delete;
  virtual ~ElementForces() = default;

  /// The order of rows and elements.
  virtual const Layout& layout() const = 0;

  /// The state of the undeformed body.
  virtual State<Real> undeformed() const = 0;

  /// Whether the forces also depend on the increment of the state; otherwise it need not be set.
  virtual bool needs_increment() const = 0;

  /// Sets `force` to the internal nodal forces (N) and advances the history by one step. Allocates nothing.
  /// The bits do not depend on the number of threads and ranks. Of several ranks each knows the forces of its
  /// Layout::row_blocks, from the displacements of the same.
  virtual void evaluate(State<Real>& state, Rows<Real>& force) const = 0;

  /// Makes displacements, increments and history known to all ranks.
  virtual void gather(State<Real>& state) const = 0;
};

/// What is read from a state: energies of the whole mesh, and values of each element in the numbering of the
/// mesh, of which only those of chunks that the rank owns are set.
template <class Real>
class ElementFields {
 public:
  virtual ~ElementFields() = default;

  /// Strain and hourglass energy of the whole mesh, of all ranks.
  virtual StrainEnergies energies(const State<Real>& state) const = 0;

  /// Hourglass energy per reference volume (J/m^3).
  virtual void hourglass_energy_densities(const State<Real>& state, std::span<double> densities) const = 0;

  /// Volume ratios.
  virtual void jacobians(const State<Real>& state, std::span<double> jacobians) const = 0;

  /// Smallest det F at the integration points; not positive means inverted.
  virtual void smallest_jacobians(const State<Real>& state, std::span<double> jacobians) const = 0;

  /// Cauchy stresses (Pa) of the material, averaged over the current volume of the element: nine numbers
  /// each, the rows of the tensor. `coordinates` are those of the nodes (m), see centred_coordinates.
  virtual void stresses(const State<Real>& state, const Rows<Real>& coordinates,
                        std::span<double> stresses) const = 0;

  /// The power (W) of each element's forces at nodal velocities v (m/s): their scalar product. In double
  /// precision, as derivatives are; throws std::logic_error in any other.
  virtual void powers(const State<Real>& state, const Rows<Real>& v, std::span<double> powers) const = 0;

  /// Upper bounds of the largest eigenvalue (N/m) of the tangent stiffness.
  virtual void stiffness_bounds(const State<Real>& state, std::span<double> bounds) const = 0;
};

/// The levels of a method's elements.
template <class Real>
class ElementAdaptivity {
 public:
  virtual ~ElementAdaptivity() = default;

  /// Gives each element the cheapest sufficient level, if the method has several. The difference between an
  /// element's force and that at the highest level, times `mobility` (m/N, by row and component), displaces
  /// its nodes. An element is promoted to the lowest level at which no node is displaced by more than
  /// `length` (m), and demoted to the lowest at which none is by more than `demoting_length` <= length, never
  /// if that is 0. Elements that fill otherwise empty lanes may be at a higher level.
  virtual Adaptation adapt(State<Real>& state, const Rows<Real>& mobility, double length,
                           double demoting_length) const = 0;

  /// The level of each element, 0 the cheapest; empty if the method has only one.
  virtual std::vector<double> levels(const State<Real>& state) const = 0;

  /// Sets the levels. Throws InputError if one is not a level of the method: they may come from a file.
  virtual void set_levels(State<Real>& state, const std::vector<double>& levels) const = 0;
};

/// Elements whose pressures are unknowns of their own, as the search for a static equilibrium takes them.
template <class Real>
class ElementPressures {
 public:
  virtual ~ElementPressures() = default;

  /// Sets `force` to the nodal forces (N) of pressures p - q(J) (Pa), one for each element in the numbering
  /// of the mesh, J its volume ratio, q the pressure of its material less (K - lambda) (J - 1), which is
  /// lambda (J - 1) unless its volumetric part is another, and `defect` to V (q(J) - p) / lambda (m^3). Added
  /// to the internal forces, they replace the part of each element's own pressure that belongs to lambda by
  /// p.
  virtual void replace_pressures(const State<Real>& state, std::span<const Real> p,
                                 std::span<const double> lambdas, Rows<Real>& force,
                                 std::span<Real> defect) const = 0;
};

/// The elements of a mesh with one method and their materials.
template <class Real>
class InternalForce : public ElementForces<Real>,
                      public ElementFields<Real>,
                      public ElementAdaptivity<Real>,
                      public ElementPressures<Real> {};

/// Whether this program was linked with `sandglass_scalar`.
bool has_scalar_kernels();

/// Elements in one of the two precisions.
using AnyInternalForce =
    std::variant<std::unique_ptr<InternalForce<double>>, std::unique_ptr<InternalForce<float>>>;

/// The elements of `mesh` with the chosen method; the only place where the choice is dispatched. Hourglass
/// controls that damp need densities; with zero they give no force. Throws InputError for an unknown method
/// (listing the known ones), for a kappa given to a method that takes none, for a law that the method does
/// not support, for values out of range, for scalar kernels in single precision, which do not exist, and for
/// what the chosen processor does not support.
AnyInternalForce make_internal_force(const Mesh& mesh, const Materials& materials,
                                     const MethodChoice& choice);

/// The same for a body of one material.
inline AnyInternalForce make_internal_force(const Mesh& mesh, const AnyLaw& law, const MethodChoice& choice,
                                            double density = 0.0) {
  return make_internal_force(mesh, Materials{{{law, density}}}, choice);
}

/// The state of a body whose nodes have moved from the undeformed state to displacements u (m) in one step.
template <class Real>
State<Real> state_at(const ElementForces<Real>& elements, const NodalField& u);

/// Nodal values of the mesh as rows of a layout; spare rows are zero.
template <class Real>
Rows<Real> to_rows(const NodalField& field, const Layout& layout);

/// Rows of a layout as nodal values of the mesh.
template <class Real>
NodalField to_field(const Rows<Real>& rows, const Layout& layout);

}  // namespace sandglass
