/// Every method with one law that remembers nothing and, where it can, one that does, on packs of doubles:
/// the threaded loops do not differ between laws, and the thread sanitizer need not see minutes of kernels.

#include <array>

#include "assembly/assemble.hpp"
#include "assembly/method_facts.hpp"
#include "element/methods.hpp"

namespace sandglass {

namespace {

template <class Method>
ForceOf<Pack<double>> few(const Mesh& mesh, const AnyLaw& any_law, const HourglassSettings& settings,
                          int threads) {
  ForceOf<Pack<double>> elements;
  const auto make = [&]<class Law>(const Law& law) {
    if constexpr (knows_law<Method, Law>) {
      elements = std::make_unique<AssemblyOf<Method, Law, Pack<double>>>(mesh, law, settings, threads);
    }
  };
  if (const auto* law = std::get_if<NeoHookean>(&any_law)) {
    make(*law);
  } else {
    make(std::get<Viscoelastic<NeoHookean>>(any_law));
  }
  return elements;
}

}  // namespace

template <class Method>
MethodEntry method_entry() {
  MethodEntry entry = method_facts<Method>();
  entry.assemble_packed_double = &few<Method>;
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
