#pragma once

#include "element/method_choice.hpp"
#include "material/materials.hpp"
#include "mesh/mesh.hpp"
#include "written/force_program.hpp"

namespace sandglass {

/// The constants of element e of a mesh with these materials; see `element_constants`.
inline std::vector<double> constants_of(const Mesh& mesh, const Materials& materials,
                                        const MethodChoice& choice, std::size_t e) {
  const Material& material = materials.list[materials.of(e)];
  const HourglassSettings settings{
      .kappa = choice.kappa, .density = material.density, .kappa_modulus = choice.kappa_modulus};
  return element_constants(choice.method, gather(mesh.points, mesh.cells[e]),
                           elastic_law(kernel_law(material)),
                           materials.axes.empty() ? nullptr : &materials.axes[e], settings);
}

}  // namespace sandglass
