/// Every method on packs of doubles alone: the threaded loops do not differ between number types, and the
/// thread sanitizer need not see minutes of kernels.

#include <array>
#include <tuple>

#include "assembly/assemble.hpp"
#include "element/methods.hpp"

namespace sandglass {

template <class Method, class Number>
Kernels<Number> kernels() {
  if constexpr (std::is_same_v<Number, Pack<double>>) return {.assemble = &assemble<Method, Number>};
  return {};
}

namespace {

/// Makes the compiler emit the kernels of all methods, which their list names.
template <class... Method>
auto kernels_of(TypeList<Method...> /*methods*/) {
  return std::tuple{std::array{&kernels<KernelOwner<Method>, Pack<double>>...},
                    std::array{&kernels<KernelOwner<Method>, Pack<float>>...}};
}

[[gnu::used]] const auto few = kernels_of(Methods{});

}  // namespace

}  // namespace sandglass
