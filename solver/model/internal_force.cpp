#include "model/internal_force.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/names.hpp"
#include "element/methods.hpp"
#include "model/element_assembly.hpp"

namespace sandglass {

namespace {

/// Calls visit.operator()<Method>() for the method of that name, or throws.
template <class Visitor>
void with_method(std::string_view name, Visitor&& visit) {
  if (!with_named_type(Methods{}, name, visit)) {
    throw InputError(
        fmt::format("method: '{}' is not known; {}", name, suggestion(name, names_of(Methods{}))));
  }
}

}  // namespace

std::unique_ptr<InternalForce> make_internal_force(const Mesh& mesh, std::string_view method,
                                                   const AnyLaw& any_law, const HourglassSettings& settings) {
  std::unique_ptr<InternalForce> force;
  with_method(method, [&]<class Method>() {
    if (settings.kappa && !Method::Hourglass::takes_kappa) {
      throw InputError(fmt::format("kappa: {} was given, but method '{}' has no such parameter; leave it out",
                                   *settings.kappa, method));
    }
    if (settings.kappa && !(*settings.kappa >= 0.0)) {
      throw InputError(fmt::format("kappa: {} must be in [0, inf), or 'auto'", *settings.kappa));
    }
    std::visit(
        [&]<class Law>(const Law& law) {
          force = std::make_unique<ElementAssembly<FormulationOf<Method, Law>, Law, Pack<double>>>(mesh, law,
                                                                                                   settings);
        },
        any_law);
  });
  return force;
}

bool takes_kappa(std::string_view method) {
  bool takes = false;
  with_method(method, [&]<class Method>() { takes = Method::Hourglass::takes_kappa; });
  return takes;
}

std::optional<double> auto_kappa(std::string_view method, const AnyLaw& any_law) {
  std::optional<double> kappa;
  with_method(method, [&]<class Method>() {
    if constexpr (Method::Hourglass::takes_kappa) {
      kappa = std::visit([](const auto& law) { return Method::Hourglass::auto_kappa(law); }, any_law);
    }
  });
  return kappa;
}

}  // namespace sandglass
