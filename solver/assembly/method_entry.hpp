#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "assembly/internal_force.hpp"
#include "element/element_work.hpp"
#include "math/lanes.hpp"

namespace sandglass {

/// Elements that compute as many at a time as `Number` holds.
template <class Number>
using ForceOf = std::unique_ptr<InternalForce<typename Lanes<Number>::Scalar>>;

/// Makes the elements of a mesh with a law that the method knows.
template <class Number>
using Assemble = ForceOf<Number>(const Mesh&, const KernelLaw&, const HourglassSettings&, int threads);

/// A method as the program knows it while it runs. `element/methods/` says what it is to the compiler; its
/// kernels stand behind the functions here, each method's in source files of their own, so that a change of
/// one compiles nothing else.
struct MethodEntry {
  std::string_view name;
  std::string_view summary;
  int integration_points = 0;
  bool controls_hourglass = false;         ///< something resists hourglass modes, or tries to
  bool damps_only = false;                 ///< what resists them resists velocities alone
  bool takes_kappa = false;                ///< a user may choose the strength of its hourglass control
  bool kappa_affects_equilibrium = false;  ///< and that changes its answers at rest
  bool is_linear = false;                  ///< forces are linear in the displacements, f = K u
  bool is_condensed = false;               ///< answers by condensation instead of steps
  bool knows_relaxation = true;            ///< takes notice of laws that relax
  std::vector<std::string_view> levels =
      {};  ///< of an adaptive method, methods from the cheapest on; else none

  Assemble<Pack<double>>* assemble_packed_double = nullptr;
  Assemble<Pack<float>>* assemble_packed_float = nullptr;
  Assemble<double>* assemble_scalar_double = nullptr;

  /// The number that `auto` stands for; none when the method takes no kappa.
  std::optional<double> (*auto_kappa)(const CalledLaw&, KappaModulus) = nullptr;

  /// Operations of one element and step, counted by running the kernel. They do not depend on the law's
  /// parameters.
  OperationCount (*operations)(const KernelLaw&) = nullptr;

  /// What an element reads and writes in a step.
  Traffic (*traffic)(const KernelLaw&) = nullptr;

  /// Whether the method chooses the level of each element.
  bool adapts() const { return !levels.empty(); }
};

/// The elements of a mesh with a method, for `MethodEntry`. Defined in `assembly/assemble.hpp`.
template <class Method, class Number>
ForceOf<Number> assemble(const Mesh& mesh, const KernelLaw& law, const HourglassSettings& settings,
                         int threads);

/// The entry of a method. Defined in `assembly/method_entry_of.hpp`.
template <class Method>
MethodEntry method_entry();

/// All methods, in the order of THE list; see `element/methods.hpp`.
const std::vector<MethodEntry>& methods();

/// Their names.
std::vector<std::string> method_names();

/// The method of that name. Throws InputError when there is none, naming the key, and the nearest known.
const MethodEntry& method_named(std::string_view name, std::string_view key = "method");

/// The golden's own element: eight points and one pressure, what every other method is held against.
inline constexpr std::string_view golden_method = "tl-mean-dilatation";

}  // namespace sandglass
