#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "element/hourglass_settings.hpp"
#include "material/laws.hpp"
#include "mesh/mesh.hpp"

namespace sandglass {

/// Energies of the whole mesh, J.
struct StrainEnergies {
  double strain = 0.0;
  double hourglass = 0.0;
};

/// The elements of a mesh with one method and one law: displacements in, internal forces out. This interface
/// is where the choice made at run time ends; behind it loops are monomorphic. Everything is const: it may be
/// shared by threads.
class InternalForce {
 public:
  InternalForce() = default;
  InternalForce(const InternalForce&) = delete;
  InternalForce& operator=(const InternalForce&) = delete;
  virtual ~InternalForce() = default;

  /// Sets `force` (N) to the internal nodal forces at displacements `u` (m). Allocates nothing.
  virtual void evaluate(const NodalField& u, NodalField& force) const = 0;

  /// Strain and hourglass energy at `u`.
  virtual StrainEnergies energies(const NodalField& u) const = 0;

  /// Hourglass energy per reference volume of each element (J/m^3).
  virtual void hourglass_energy_densities(const NodalField& u, std::span<double> densities) const = 0;

  /// Volume ratio of each element.
  virtual void jacobians(const NodalField& u, std::span<double> jacobians) const = 0;

  /// Smallest det F at the integration points of each element; not positive means inverted.
  virtual void smallest_jacobians(const NodalField& u, std::span<double> jacobians) const = 0;

  /// Upper bound of the largest eigenvalue (N/m) of each element's tangent stiffness at `u`.
  virtual void stiffness_bounds(const NodalField& u, std::span<double> bounds) const = 0;
};

/// THE place of dispatch: the elements of `mesh` with the method of that name.
/// Throws InputError for an unknown method (naming the known ones) and for a kappa given to a method that
/// takes none.
std::unique_ptr<InternalForce> make_internal_force(const Mesh& mesh, std::string_view method,
                                                   const AnyLaw& law, const HourglassSettings& settings);

/// Whether the method of that name takes the hourglass stiffness parameter kappa. Throws InputError when
/// unknown.
bool takes_kappa(std::string_view method);

/// The number that `auto` stands for, or none when the method takes no kappa.
std::optional<double> auto_kappa(std::string_view method, const AnyLaw& law);

}  // namespace sandglass
