#include "solve/law_stiffening.hpp"

#include <algorithm>

#include "assembly/method_entry.hpp"
#include "element/one_point.hpp"
#include "material/stiffening.hpp"

namespace sandglass {

LawStiffening::LawStiffening(const Model& model)
    : mesh_(model.scene().mesh),
      materials_(model.scene().materials),
      laws_(by_material(materials_, [&](const Material& material) {
        const bool known = !method_named(model.choice().method).is_linear && splits_volume(material.law);
        return known ? std::optional(elastic_law(kernel_law(material))) : std::nullopt;
      })) {}

bool LawStiffening::is_known() const {
  return std::ranges::any_of(laws_, [](const auto& law) { return law.has_value(); });
}

std::vector<float> LawStiffening::by_cell(const Rows<float>& u, const Layout& layout) const {
  std::vector<float> stiffenings(layout.elements.size(), 1.0f);
  if (!is_known()) return stiffenings;
  layout.cell_blocks.for_each([&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      if (layout.elements[c] < 0) continue;
      const std::size_t e = at(layout.elements[c]);
      const auto& law = laws_[materials_.of(e)];
      if (!law) continue;
      const auto element = OnePoint::geometry(to_modes(gather(mesh_.points, mesh_.cells[e])));
      NodalVectors<double> nodal;
      for (int I = 0; I < nodal.rows; ++I) {
        const Row<float>& row = u[at(layout.row_of_node[at(mesh_.cells[e][at(I)])])];
        for (int i = 0; i < 3; ++i) nodal(I, i) = row[at(i)];
      }
      stiffenings[c] =
          static_cast<float>(stiffening(*law, OnePoint::mean_gradient(to_modes(nodal), element),
                                        materials_.axes.empty() ? nullptr : &materials_.axes[e]));
    }
  });
  layout.gather_cells(stiffenings.data());
  return stiffenings;
}

}  // namespace sandglass
