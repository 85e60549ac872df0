#pragma once

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/names.hpp"
#include "element/methods.hpp"
#include "model/element_assembly.hpp"

/// From a method's name to its kernels. One source file per number type compiles them, side by side.
namespace sandglass {

/// Calls visit.operator()<Method>() for the method of that name, or throws.
template <class Visitor>
void with_method(std::string_view name, Visitor&& visit) {
  if (!with_named_type(Methods{}, name, visit)) {
    throw InputError(
        fmt::format("method: '{}' is not known; {}", name, suggestion(name, names_of(Methods{}))));
  }
}

/// The elements of a mesh, as many at a time as `Number` holds.
template <class Number>
auto assemble(const Mesh& mesh, const AnyLaw& any_law, const MethodChoice& choice, double density) {
  std::unique_ptr<InternalForce<typename Lanes<Number>::Scalar>> force;
  with_method(choice.method, [&]<class Method>() {
    std::visit(
        [&]<class Law>(const Law& law) {
          force = std::make_unique<ElementAssembly<FormulationOf<Method, Law>, Law, Number>>(
              mesh, law, HourglassSettings{choice.kappa, density}, choice.threads);
        },
        any_law);
  });
  return force;
}

std::unique_ptr<InternalForce<double>> make_packed_double(const Mesh&, const AnyLaw&, const MethodChoice&,
                                                          double);
std::unique_ptr<InternalForce<float>> make_packed_float(const Mesh&, const AnyLaw&, const MethodChoice&,
                                                        double);
std::unique_ptr<InternalForce<double>> make_scalar_double(const Mesh&, const AnyLaw&, const MethodChoice&,
                                                          double);

}  // namespace sandglass
