/// Every method on packs of doubles alone: the threaded loops do not differ between number types, and the
/// thread sanitizer need not see minutes of kernels.

#include <array>

#include "assembly/assemble.hpp"
#include "assembly/method_facts.hpp"
#include "element/methods.hpp"

namespace sandglass {

template <class Method>
MethodEntry method_entry() {
  MethodEntry entry = method_facts<Method>();
  entry.assemble_packed_double = &assemble<KernelOwner<Method>, Pack<double>>;
  return entry;
}

namespace {

/// Makes the compiler emit all entries, which the list is made of.
template <class... Method>
auto entries_of(TypeList<Method...> /*methods*/) {
  return std::array{&method_entry<Method>...};
}

[[gnu::used]] const auto entries = entries_of(Methods{});

}  // namespace

}  // namespace sandglass
