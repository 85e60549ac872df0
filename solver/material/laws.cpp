#include "material/laws.hpp"

namespace sandglass {

namespace {

template <class Law>
KernelLaw to_kernel_law(const Law& law, VolumetricPart volume) {
  return CalledLaw(law, volume);
}
KernelLaw to_kernel_law(const NeoHookean& law, VolumetricPart volume) {
  if (std::holds_alternative<QuadraticPart>(volume)) return law;
  return CalledLaw(law, volume);
}
template <class Law>
KernelLaw to_kernel_law(const Viscoelastic<Law>& law, VolumetricPart volume) {
  return Viscoelastic<CalledLaw>{CalledLaw(static_cast<const Law&>(law), volume), law.relaxation_1,
                                 law.time_1, law.relaxation_2, law.time_2};
}

}  // namespace

KernelLaw kernel_law(const AnyLaw& any_law, VolumetricPart volume) {
  return std::visit([=](const auto& law) { return to_kernel_law(law, volume); }, any_law);
}

CalledLaw elastic_law(const KernelLaw& kernel_law) {
  if (const auto* law = std::get_if<NeoHookean>(&kernel_law)) return CalledLaw(*law);
  if (const auto* law = std::get_if<CalledLaw>(&kernel_law)) return *law;
  return static_cast<const CalledLaw&>(std::get<Viscoelastic<CalledLaw>>(kernel_law));
}

}  // namespace sandglass
