#include "material/materials.hpp"

#include <algorithm>
#include <cmath>

namespace sandglass {

namespace {

/// An elastic law as a viscoelastic one without relaxation.
Viscoelastic<CalledLaw> to_viscoelastic(const KernelLaw& law) {
  if (const auto* viscoelastic = std::get_if<Viscoelastic<CalledLaw>>(&law)) return *viscoelastic;
  return {elastic_law(law), 0.0, 1.0, 0.0, 1.0};
}

template <class Law>
bool holds(const KernelLaw& law) {
  return std::holds_alternative<Law>(law);
}

bool alike(const Material& a, const Material& b) {
  if (a.volume.index() != b.volume.index() || a.law.index() != b.law.index()) return false;
  return std::visit(
      [&]<class Law>(const Law& law) {
        const Law& other = std::get<Law>(b.law);
        return std::apply([&](const auto&... p) { return ((law.*p.member == other.*p.member) && ...); },
                          Law::parameters());
      },
      a.law);
}

}  // namespace

Materials materials_of(const Materials& whole, std::span<const int> elements) {
  Materials part{whole.list};
  for (const int e : elements) {
    const auto n = static_cast<std::size_t>(e);
    if (!whole.of_element.empty()) part.of_element.push_back(whole.of_element[n]);
    if (!whole.axes.empty()) part.axes.push_back(whole.axes[n]);
  }
  return part;
}

KernelLaws kernel_laws(const Materials& materials) {
  const std::vector<KernelLaw> laws =
      by_material(materials, [](const Material& material) { return kernel_law(material); });
  const auto converted = [&](const auto& convert) {
    std::vector<std::decay_t<decltype(convert(laws.front()))>> list;
    for (const KernelLaw& law : laws) list.push_back(convert(law));
    return list;
  };
  if (std::any_of(laws.begin(), laws.end(), holds<Viscoelastic<CalledLaw>>))
    return converted(to_viscoelastic);
  if (std::any_of(laws.begin(), laws.end(), holds<CalledLaw>)) return converted(elastic_law);
  return converted([](const KernelLaw& law) { return std::get<NeoHookean>(law); });
}

std::vector<std::size_t> numbers_of_alike(const Materials& materials) {
  std::vector<std::size_t> numbers, firsts;
  for (std::size_t m = 0; m < materials.list.size(); ++m) {
    std::size_t n = 0;
    while (n < firsts.size() && !alike(materials.list[firsts[n]], materials.list[m])) ++n;
    if (n == firsts.size()) firsts.push_back(m);
    numbers.push_back(n);
  }
  return numbers;
}

std::vector<double> shear_moduli(const Materials& materials) {
  return by_material(materials, [](const Material& material) {
    return std::visit([](const auto& law) { return law.shear_modulus(); }, material.law);
  });
}

std::vector<double> lame_lambdas(const Materials& materials) {
  return by_material(materials, [](const Material& material) {
    return std::visit([](const auto& law) { return lame_lambda(law); }, material.law);
  });
}

double largest_lambda_over_mu(const Materials& materials) {
  const std::vector<double> lambdas = lame_lambdas(materials), moduli = shear_moduli(materials);
  double largest = -INFINITY;
  for (std::size_t m = 0; m < moduli.size(); ++m) largest = std::max(largest, lambdas[m] / moduli[m]);
  return largest;
}

}  // namespace sandglass
