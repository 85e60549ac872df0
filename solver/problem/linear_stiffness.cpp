#include "problem/linear_stiffness.hpp"

#include "base/error.hpp"
#include "element/methods.hpp"

namespace sandglass {

namespace {

template <class Kernel, class Law>
ElementStiffness stiffness_of(const typename Kernel::template Element<double>& element, const Law& law) {
  ElementStiffness K;
  typename Kernel::template History<double> none;
  for (std::size_t column = 0; column < 24; ++column) {
    NodalVectors<double> unit{};
    unit.entries[column] = 1.0;
    const ElementMotion<double> motion{to_modes(unit), {}, {}, 0.0, {}};
    const NodalVectors<double> force =
        from_modes(Kernel::force(Kernel::deformation(motion, element), element, none, law));
    for (std::size_t row = 0; row < 24; ++row) K.entries[24 * row + column] = force.entries[row];
  }
  return K;
}

}  // namespace

void for_each_stiffness(const Model& model,
                        const std::function<void(const Hexahedron&, const ElementStiffness&)>& visit) {
  const MethodChoice& choice = model.choice();
  const Mesh& mesh = model.scene().mesh;
  with_named_type(Methods{}, choice.method, [&]<class Method>() {
    if constexpr (is_linear<Method>) {
      const HourglassSettings settings{.kappa = choice.kappa, .kappa_modulus = choice.kappa_modulus};
      const Materials& materials = model.scene().materials;
      for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
        const Hexahedron& cell = mesh.cells[e];
        using Kernel = FormulationOf<Method, CalledLaw>;
        const CalledLaw called = elastic_law(kernel_law(materials.list[materials.of(e)]));
        const auto law = called.with_axes(materials.axes.empty() ? nullptr : &materials.axes[e]);
        const auto element = Kernel::precompute(gather(mesh.points, cell), law, settings);
        visit(cell, stiffness_of<Kernel>(element, law));
      }
    } else {
      throw InputError(fmt::format("method '{}' has no constant stiffness; allowed: the linear methods, '{}'",
                                   Method::name, Linear::name));
    }
  });
}

}  // namespace sandglass
