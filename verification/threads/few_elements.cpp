/// All methods, only with packs of doubles: the threaded loops are the same for all number types, and the
/// thread sanitizer need not check kernels that take minutes.

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

/// Instantiates the kernels of all methods, which the list of methods refers to.
template <class... Method>
auto kernels_of(TypeList<Method...> /*methods*/) {
  return std::tuple{std::array{&kernels<KernelOwner<Method>, Pack<double>>...},
                    std::array{&kernels<KernelOwner<Method>, Pack<float>>...}};
}

[[gnu::used]] const auto few = kernels_of(Methods{});

}  // namespace

}  // namespace sandglass
