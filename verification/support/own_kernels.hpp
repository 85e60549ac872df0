#pragma once

#include <array>
#include <string_view>
#include <tuple>

#include "assembly/method_entry.hpp"
#include "element/methods.hpp"

/// For programs that define `kernels` themselves, in the one source that includes this: the list of methods
/// refers to the kernels of all, and to none for batches.
namespace sandglass {

template <>
AssembleBatch<Pack<double>>* batch_kernels<Pack<double>>(std::string_view /*method*/) {
  return nullptr;
}
template <>
AssembleBatch<Pack<float>>* batch_kernels<Pack<float>>(std::string_view /*method*/) {
  return nullptr;
}

namespace {

template <class... Method>
auto kernels_of(TypeList<Method...> /*methods*/) {
  return std::tuple{std::array{&kernels<KernelOwner<Method>, Pack<double>>...},
                    std::array{&kernels<KernelOwner<Method>, Pack<float>>...}};
}

[[gnu::used]] const auto all_kernels = kernels_of(Methods{});

}  // namespace

}  // namespace sandglass
