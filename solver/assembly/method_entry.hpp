#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "assembly/internal_force.hpp"
#include "math/pack.hpp"

namespace sandglass {

/// The elements of a mesh, computed as many at a time as `Number` has lanes.
template <class Number>
using ForceOf = std::unique_ptr<InternalForce<typename Lanes<Number>::Scalar>>;

/// Makes the elements of a mesh with materials whose laws the method supports.
template <class Number>
using Assemble = ForceOf<Number>(const Mesh&, const Materials&, const HourglassSettings&, const Team& team);

template <class Number>
class BatchForce;

/// Makes the elements of as many bodies of one mesh as `Number` has lanes.
template <class Number>
using AssembleBatch = std::unique_ptr<BatchForce<Number>>(const Mesh&, const Materials&,
                                                          const HourglassSettings&);

/// A method at run time. Its definition at compile time is in `element/methods/`; its kernels are called
/// through the functions here and compiled in source files of their own, so that a change of one method
/// recompiles nothing else.
struct MethodEntry {
  std::string_view name;
  std::string_view summary;
  int integration_points = 0;
  bool controls_hourglass = false;         ///< hourglass modes are resisted, by a control or by more points
  bool damps_only = false;                 ///< only their velocities are resisted
  bool takes_kappa = false;                ///< a user may choose the strength of its hourglass control
  bool kappa_affects_equilibrium = false;  ///< and kappa changes its static answers
  bool pressure_varies = false;            ///< an element has more than one pressure
  bool is_linear = false;                  ///< forces are linear in the displacements, f = K u
  bool is_condensed = false;               ///< answers by condensation instead of steps
  bool knows_viscoelasticity = true;       ///< supports viscoelastic laws
  std::vector<std::string_view> levels =
      {};  ///< of an adaptive method, methods from the cheapest on; else none

  Assemble<Pack<double>>* assemble_packed_double = nullptr;
  Assemble<Pack<float>>* assemble_packed_float = nullptr;
  Assemble<double>* assemble_scalar_double = nullptr;  ///< none unless a program links `sandglass_scalar`

  AssembleBatch<Pack<double>>* assemble_batch_double = nullptr;  ///< none unless the method declares it
  AssembleBatch<Pack<float>>* assemble_batch_float = nullptr;

  /// The value of `auto` for kappa; none if the method takes no kappa.
  std::optional<double> (*auto_kappa)(const CalledLaw&, KappaModulus) = nullptr;

  /// Whether the method chooses the level of each element.
  bool adapts() const { return !levels.empty(); }
};

/// The elements of a mesh with a method, for `MethodEntry`. Defined in `assembly/assemble.hpp`.
template <class Method, class Number>
ForceOf<Number> assemble(const Mesh& mesh, const Materials& materials, const HourglassSettings& settings,
                         const Team& team);

/// The same, one element at a time, to compare with. Weak: null in a program without `sandglass_scalar`, for
/// these kernels serve tests and benchmarks alone. Defined in `assembly/assemble.hpp`.
template <class Method>
[[gnu::weak]] ForceOf<double> assemble_scalar(const Mesh& mesh, const Materials& materials,
                                              const HourglassSettings& settings, const Team& team);

/// The elements of bodies side by side, for `MethodEntry`. Defined in `assembly/batch_force.hpp`.
template <class Method, class Number>
std::unique_ptr<BatchForce<Number>> assemble_batch(const Mesh& mesh, const Materials& materials,
                                                   const HourglassSettings& settings);

/// The entry of a method. Defined in `assembly/method_entry_of.hpp`.
template <class Method>
MethodEntry method_entry();

/// All methods, in the order of the list in `element/methods.hpp`.
const std::vector<MethodEntry>& methods();

/// Their names.
std::vector<std::string> method_names();

/// The method called `name`. Throws InputError if there is none; the error names `key` and suggests known
/// names.
const MethodEntry& method_named(std::string_view name, std::string_view key = "method");

}  // namespace sandglass
