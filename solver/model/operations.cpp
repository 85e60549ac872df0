#include "model/operations.hpp"

#include "element/operation_count.hpp"
#include "model/method_dispatch.hpp"

namespace sandglass {

namespace {

/// A law to count: every elastic law as one type, so that the kernels are not compiled anew for each.
template <class Law>
auto counted_law(const Law& law) {
  if constexpr (law_remembers<Law>) {
    return kernel_law(law);
  } else {
    return AnyElasticLaw<ElasticLaws>(law);
  }
}

}  // namespace

Operations operations_of(std::string_view method, const AnyLaw& any_law) {
  Operations operations;
  with_method(method, [&]<class Method>() {
    operations = std::visit(
        [](const auto& law) {
          return count_operations<typename Method::Kinematics, typename Method::Hourglass>(counted_law(law))
              .total;
        },
        any_law);
  });
  return operations;
}

}  // namespace sandglass
