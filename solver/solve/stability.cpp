#include "solve/stability.hpp"

#include <algorithm>

#include "assembly/method_entry.hpp"

namespace sandglass {

bool leaves_hourglass_modes(const MethodChoice& choice) {
  const MethodEntry& method = method_named(choice.method);
  return !method.controls_hourglass || method.damps_only;
}

std::string why_not_decided(const Model& model, bool depends_on_path) {
  if (depends_on_path) return "forces depend on the path";
  for (const auto& force : model.scene().forces)
    if (!force->traits().no_potential.empty()) return std::string(force->traits().no_potential);
  if (leaves_hourglass_modes(model.choice())) return "hourglass modes are not resisted";
  if (method_named(model.choice().method).is_linear) return "";
  // The softest motions are computed with less resistance to volume changes. Such a law does not separate
  // it, so the result would depend on the orientation.
  const auto splits = [](const Material& material) { return splits_volume(material.law); };
  return std::ranges::all_of(model.scene().materials.list, splits) ? ""
                                                                   : "a law has no separate volumetric part";
}

}  // namespace sandglass
