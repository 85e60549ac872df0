/// All methods, only with packs of doubles: the threaded loops are the same for all number types, and the
/// thread sanitizer need not check kernels that take minutes.

#include <array>
#include <string_view>
#include <tuple>

#include "assembly/assemble.hpp"
#include "assembly/method_entry.hpp"
#include "element/methods.hpp"

namespace sandglass {

template <class Method, class Number>
Kernels<Number> kernels() {
  if constexpr (std::is_same_v<Number, Pack<double>>) return {.assemble = &assemble<Method, Number>};
  return {};
}

template <>
AssembleBatch<Pack<double>>* batch_kernels<Pack<double>>(std::string_view /*method*/) {
  return nullptr;
}
template <>
AssembleBatch<Pack<float>>* batch_kernels<Pack<float>>(std::string_view /*method*/) {
  return nullptr;
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
