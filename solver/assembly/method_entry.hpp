#pragma once

#include <optional>
#include <span>
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

/// Makes the elements of as many bodies of one mesh as `Number` has lanes, from the materials that all of
/// them have, or from those of each, which differ in the numbers of their laws.
template <class Number>
using AssembleBatch = std::unique_ptr<BatchForce<Number>>(const Mesh&, std::span<const Materials>,
                                                          const HourglassSettings&);

/// What a method computes with on a number type.
template <class Number>
struct Kernels {
  Assemble<Number>* assemble = nullptr;
  AssembleBatch<Number>* assemble_batch = nullptr;  ///< none unless the method states `Batches`
};

/// A method at run time. Its definition at compile time is in `element/methods/`; its kernels are compiled in
/// source files of their own, so that a change of one method recompiles no other.
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

  Kernels<Pack<double>> packed_double = {};
  Kernels<Pack<float>> packed_float = {};
  Kernels<double> (*scalar_double)() = nullptr;  ///< null unless a program links `sandglass_scalar`

  /// The value of `auto` for kappa; none if the method takes no kappa.
  std::optional<double> (*auto_kappa)(const CalledLaw&, KappaModulus) = nullptr;

  /// Whether the method chooses the level of each element.
  bool adapts() const { return !levels.empty(); }
};

/// The kernels of a method, none if they are those of another one. Defined in `assembly/kernels.hpp`.
template <class Method, class Number>
Kernels<Number> kernels();

/// The same for one element at a time, to compare with. Weak: null in a program without `sandglass_scalar`,
/// for these kernels serve tests and benchmarks alone.
template <class Method>
[[gnu::weak]] Kernels<double> scalar_kernels();

/// The kernels for bodies side by side of the method called `name`; null unless it states `Batches`. They are
/// compiled apart from those of single bodies, as the compiler inlines less in large sources.
template <class Number>
AssembleBatch<Number>* batch_kernels(std::string_view name);
template <>
AssembleBatch<Pack<double>>* batch_kernels<Pack<double>>(std::string_view name);
template <>
AssembleBatch<Pack<float>>* batch_kernels<Pack<float>>(std::string_view name);

/// All methods, in the order of the list in `element/methods.hpp`.
const std::vector<MethodEntry>& methods();

/// Their names.
std::vector<std::string> method_names();

/// The method called `name`. Throws InputError if there is none; the error names `key` and suggests known
/// names.
const MethodEntry& method_named(std::string_view name, std::string_view key = "method");

}  // namespace sandglass
