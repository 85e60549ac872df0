#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "assembly/layout.hpp"
#include "element/hourglass_settings.hpp"
#include "material/laws.hpp"
#include "math/rows.hpp"

namespace sandglass {

/// Energies of the whole mesh, J.
struct StrainEnergies {
  double strain = 0.0;
  double hourglass = 0.0;
};

/// The levels of a method's elements, and how they stand together. Only the elements know what is in it.
class ElementLevels {
 public:
  ElementLevels() = default;
  ElementLevels(const ElementLevels&) = delete;
  ElementLevels& operator=(const ElementLevels&) = delete;
  virtual ~ElementLevels() = default;
};

/// What changed when elements were given new levels.
struct Adaptation {
  std::size_t promoted = 0;  ///< elements
  std::size_t demoted = 0;
};

/// What changes in time: nodal values in rows, in the order of the layout, and what elements remember.
template <class Real>
struct State {
  Rows<Real> u;               ///< displacements, m
  Rows<Real> increment;       ///< what the last step added to them, m
  std::vector<Real> history;  ///< of the elements; only they know its meaning
  std::shared_ptr<const ElementLevels> levels;
  double step = std::numeric_limits<double>::infinity();  ///< s, that the increment took; infinite where time
                                                          ///< plays no part
};

/// The elements of a mesh with one method and one law: displacements in, internal forces out. This interface
/// is where the choice made at run time ends; behind it loops are monomorphic. Everything is const: it may be
/// shared by threads.
template <class Real>
class InternalForce {
 public:
  InternalForce() = default;
  InternalForce(const InternalForce&) = delete;
  InternalForce& operator=(const InternalForce&) = delete;
  virtual ~InternalForce() = default;

  /// The order of rows and elements.
  virtual const Layout& layout() const = 0;

  /// The body at rest.
  virtual State<Real> undeformed() const = 0;

  /// Whether the forces follow from the increment of the state too; else nobody needs to write it.
  virtual bool needs_increment() const = 0;

  /// Sets `force` to the internal nodal forces (N); what elements remember goes one step on. Allocates
  /// nothing. The bits do not depend on the number of threads.
  virtual void evaluate(State<Real>& state, Rows<Real>& force) const = 0;

  /// Gives each element the cheapest level that will do, where a method has several. What its force lacks of
  /// that at the highest level, times `mobility` (m/N, by row and component), displaces its nodes: up it
  /// goes to the lowest level at which none by more than `length` (m), down to the lowest at which none by
  /// more than `demoting_length` <= length; 0: never. Those in lanes that would be empty may stand higher.
  virtual Adaptation adapt(State<Real>& /*state*/, const Rows<Real>& /*mobility*/, double /*length*/,
                           double /*demoting_length*/) const {
    return {};
  }

  /// The level of each element, 0 the cheapest; empty where a method has but one.
  virtual std::vector<double> levels(const State<Real>& /*state*/) const { return {}; }

  /// Sets them. Throws InputError where one is no level of the method, for they may have come from a file.
  virtual void set_levels(State<Real>& /*state*/, const std::vector<double>& /*levels*/) const {}

  /// Strain and hourglass energy.
  virtual StrainEnergies energies(const State<Real>& state) const = 0;

  // Per element, in the numbering of the mesh:

  /// Hourglass energy per reference volume (J/m^3).
  virtual void hourglass_energy_densities(const State<Real>& state, std::span<double> densities) const = 0;

  /// Volume ratios.
  virtual void jacobians(const State<Real>& state, std::span<double> jacobians) const = 0;

  /// Smallest det F at the integration points; not positive means inverted.
  virtual void smallest_jacobians(const State<Real>& state, std::span<double> jacobians) const = 0;

  /// Upper bounds of the largest eigenvalue (N/m) of the tangent stiffness.
  virtual void stiffness_bounds(const State<Real>& state, std::span<double> bounds) const = 0;
};

/// The numbers in which a run computes.
enum class Precision { double_precision, single_precision };

/// "double" or "float".
constexpr std::string_view name_of(Precision precision) {
  return precision == Precision::double_precision ? "double" : "float";
}

/// How many elements a kernel computes at a time: as many as a register holds, or one, for comparison.
enum class KernelWidth { pack, scalar };

/// What an adaptive method aims at unless told.
inline constexpr double default_accuracy = 0.003;

/// What a user chooses beside the case.
struct MethodChoice {
  std::string method;
  std::optional<double> kappa = {};  ///< none means auto
  Precision precision = Precision::double_precision;
  int threads = 1;
  KernelWidth kernel = KernelWidth::pack;
  KappaModulus kappa_modulus = KappaModulus::p_wave;
  double accuracy = default_accuracy;  ///< of an adaptive method: displacement error over the largest imposed
};

/// Elements in one of the two precisions.
using AnyInternalForce =
    std::variant<std::unique_ptr<InternalForce<double>>, std::unique_ptr<InternalForce<float>>>;

/// THE place of dispatch: the elements of `mesh` with the chosen method. Hourglass controls that damp need
/// the density (kg/m^3); with none they do nothing. Throws InputError for an unknown method (naming the known
/// ones), for a kappa given to a method that takes none, and for scalar kernels in single precision, which
/// nothing needs.
AnyInternalForce make_internal_force(const Mesh& mesh, const AnyLaw& law, const MethodChoice& choice,
                                     double density = 0.0);

/// The state in which a body finds itself when nodes go from rest to `u` (m) in one step.
template <class Real>
State<Real> state_at(const InternalForce<Real>& elements, const NodalField& u);

/// Nodal values of the mesh as rows of a layout; spare rows are zero.
template <class Real>
Rows<Real> to_rows(const NodalField& field, const Layout& layout);

/// Rows of a layout as nodal values of the mesh.
template <class Real>
NodalField to_field(const Rows<Real>& rows, const Layout& layout);

}  // namespace sandglass
