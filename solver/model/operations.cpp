#include "model/operations.hpp"

#include "element/operation_count.hpp"
#include "model/method_dispatch.hpp"

namespace sandglass {

Operations operations_of(std::string_view method, const AnyLaw& any_law) {
  Operations operations;
  with_method(method, [&]<class Method>() {
    operations = std::visit(
        [](const auto& law) {
          return count_operations<typename Method::Kinematics, typename Method::Hourglass>(kernel_law(law))
              .total;
        },
        any_law);
  });
  return operations;
}

}  // namespace sandglass
