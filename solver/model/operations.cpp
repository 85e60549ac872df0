#include "model/operations.hpp"

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

OperationCount operation_count(std::string_view method, const AnyLaw& any_law) {
  OperationCount count;
  with_method(method, [&]<class Method>() {
    count = std::visit(
        [](const auto& law) {
          return count_operations<typename Method::Kinematics, typename Method::Hourglass>(counted_law(law));
        },
        any_law);
  });
  return count;
}

Operations operations_of(std::string_view method, const AnyLaw& law) {
  return operation_count(method, law).total;
}

}  // namespace sandglass
