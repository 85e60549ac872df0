#include "counting/method_work.hpp"

#include "counting/operation_count.hpp"
#include "element/methods.hpp"

namespace sandglass {

namespace {

template <class Method, class Law>
MethodWork work_with(const Law& law) {
  return {count_operations<typename Method::Kinematics, typename Method::Hourglass>(law),
          traffic_of<FormulationOf<Method, Law>>()};
}

/// The law is behind calls, so that each method is compiled for two laws instead of all.
template <class Method>
MethodWork work_of_form(const KernelLaw& law) {
  if constexpr (knows_law<Method, Viscoelastic<CalledLaw>>) {
    const auto* viscoelastic = std::get_if<Viscoelastic<CalledLaw>>(&law);
    if (viscoelastic != nullptr) return work_with<Method>(*viscoelastic);
  }
  return work_with<Method>(elastic_law(law));
}

}  // namespace

MethodWork work_of(const MethodEntry& method, const KernelLaw& law, Shapes shapes) {
  MethodWork work{};
  for_each_type(Methods{}, [&]<class Method>() {
    if (method.name != Method::name) return;
    work = shapes == Shapes::any ? work_of_form<Method>(law) : work_of_form<OnParallelepipeds<Method>>(law);
  });
  return work;
}

}  // namespace sandglass
