#include "model/linear_stiffness.hpp"

#include "model/method_dispatch.hpp"

namespace sandglass {

namespace {

template <class Kernel, class Law>
ElementStiffness stiffness_of(const typename Kernel::template Element<double>& element, const Law& law) {
  ElementStiffness K;
  for (std::size_t column = 0; column < 24; ++column) {
    NodalVectors<double> unit{};
    unit.entries[column] = 1.0;
    const NodalVectors<double> force = Kernel::force(unit, element, law);
    for (std::size_t row = 0; row < 24; ++row) K.entries[24 * row + column] = force.entries[row];
  }
  return K;
}

}  // namespace

void for_each_stiffness(const Model& model,
                        const std::function<void(const Hexahedron&, const ElementStiffness&)>& visit) {
  const MethodChoice& choice = model.choice();
  const Mesh& mesh = model.scene().mesh;
  with_method(choice.method, [&]<class Method>() {
    if constexpr (is_linear<Method>) {
      std::visit(
          [&]<class Law>(const Law& law) {
            using Element = FormulationOf<Method, Law>;
            if constexpr (Element::remembers) {
              throw InputError(
                  fmt::format("law '{}' remembers, so that method '{}' has no constant stiffness", Law::name,
                              Method::name));
            } else {
              using Kernel = NodalForm<Element>;
              for (const auto& cell : mesh.cells) {
                const auto element = Kernel::precompute(gather(mesh.points, cell), law, {choice.kappa});
                visit(cell, stiffness_of<Kernel>(element, law));
              }
            }
          },
          model.scene().description.law);
    } else {
      throw InputError(fmt::format("method '{}' has no constant stiffness; allowed: the linear methods, '{}'",
                                   Method::name, LinearPerturbation::name));
    }
  });
}

}  // namespace sandglass
