/// All methods, only with packs of doubles: the threaded loops are the same for all number types, and the
/// thread sanitizer need not check kernels that take minutes.

#include "assembly/assemble.hpp"
#include "support/own_kernels.hpp"

namespace sandglass {

template <class Method, class Number>
Kernels<Number> kernels() {
  if constexpr (std::is_same_v<Number, Pack<double>>) return {.assemble = &assemble<Method, Number>};
  return {};
}

}  // namespace sandglass
