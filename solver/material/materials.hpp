#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "material/laws.hpp"

namespace sandglass {

/// The material of a body or a part of it.
struct Material {
  AnyLaw law;
  double density = 0.0;        ///< kg/m^3
  VolumetricPart volume = {};  ///< replaces the law's own
};

/// The law of a material as kernels take it.
inline KernelLaw kernel_law(const Material& material) {
  return kernel_law(material.law, material.volume);
}

/// The materials of a body.
struct Materials {
  std::vector<Material> list;
  std::vector<std::uint16_t> of_element = {};   ///< the material of each element; empty: all have the first
  std::vector<MaterialAxes<double>> axes = {};  ///< of each element; empty: those of space

  /// The number of an element's material.
  std::size_t of(std::size_t element) const { return of_element.empty() ? 0 : of_element[element]; }
};

/// The materials of some elements of a body.
Materials materials_of(const Materials& whole, std::span<const int> elements);

/// A property of each material, law or density; `property(material)` returns it.
template <class Property>
auto by_material(const Materials& materials, const Property& property) {
  std::vector<std::decay_t<decltype(property(materials.list.front()))>> values;
  for (const Material& material : materials.list) values.push_back(property(material));
  return values;
}

/// The laws of the materials as kernels take them, all of the simplest type that fits all of them.
using KernelLaws =
    std::variant<std::vector<NeoHookean>, std::vector<CalledLaw>, std::vector<Viscoelastic<CalledLaw>>>;

KernelLaws kernel_laws(const Materials& materials);

/// A number for each material, from 0. Materials with equal law and parameters share it, whatever their
/// density.
std::vector<std::size_t> numbers_of_alike(const Materials& materials);

/// Initial shear moduli of the materials, Pa.
std::vector<double> shear_moduli(const Materials& materials);

/// Lame's first parameters of the undeformed materials, Pa.
std::vector<double> lame_lambdas(const Materials& materials);

/// The largest lambda / mu of the undeformed materials.
double largest_lambda_over_mu(const Materials& materials);

}  // namespace sandglass
