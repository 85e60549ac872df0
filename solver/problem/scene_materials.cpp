#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "problem/scene_rules.hpp"

namespace sandglass {

namespace {

/// The material of each element. Throws InputError for an element that has none or two.
Materials assigned_materials(const Case& description, const Scene& scene) {
  const auto& regions = description.materials;
  Materials materials;
  for (const auto& region : regions) materials.list.push_back(region);
  if (regions.size() == 1 && regions.front().elements.empty()) return materials;
  constexpr std::uint16_t none = 0xffff;
  std::uint16_t other = none;
  auto& of_element = materials.of_element;
  of_element.assign(scene.mesh.cells.size(), none);
  for (std::size_t n = 0; n < regions.size(); ++n) {
    const auto m = static_cast<std::uint16_t>(n);
    const std::string& name = regions[n].elements;
    if (name.empty()) {
      other = m;
      continue;
    }
    for (const int e : element_set(scene, "materials.elements", name)) {
      std::uint16_t& material = of_element[at(e)];
      if (material != none) {
        throw InputError(fmt::format("{}: element {} is in '{}' and in '{}'; an element has one material",
                                     scene.settings.file.string(), e, regions[material].elements, name));
      }
      material = m;
    }
  }
  const auto left = std::count(of_element.begin(), of_element.end(), none);
  if (left > 0 && other == none) {
    throw InputError(
        fmt::format("{}: materials: {} of the {} elements have none, the first is element {}; one "
                    "of [[materials]] may leave out its elements and be that of all others",
                    scene.settings.file.string(), left, of_element.size(),
                    std::find(of_element.begin(), of_element.end(), none) - of_element.begin()));
  }
  std::replace(of_element.begin(), of_element.end(), none, other);
  return materials;
}

}  // namespace

Materials make_materials(const Case& description, const Scene& scene) {
  Materials materials = assigned_materials(description, scene);
  const auto& regions = description.materials;
  const auto plain = [](const CaseMaterial& region) {
    return std::holds_alternative<std::monostate>(region.fibres);
  };
  if (std::all_of(regions.begin(), regions.end(), plain)) return materials;
  const std::size_t elements = scene.mesh.cells.size();
  for (const auto& region : regions) {
    const auto* listed = std::get_if<ListedFibres>(&region.fibres);
    if (listed == nullptr || listed->fibres.size() == elements) continue;
    throw InputError(fmt::format("{}: fibres.file has {} rows; it must have one for each of the {} elements",
                                 scene.settings.file.string(), listed->fibres.size(), elements));
  }
  for (std::size_t e = 0; e < elements; ++e) {
    try {
      materials.axes.push_back(axes_by(regions[materials.of(e)].fibres, scene.mesh, e));
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("{}: fibres: element {}: {}", scene.settings.file.string(), e, error.what()));
    }
  }
  return materials;
}

}  // namespace sandglass
