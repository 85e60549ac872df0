/// Every method with one law that remembers nothing and, where it can, one that does, on packs of doubles:
/// the threaded loops do not differ between laws, and the thread sanitizer need not see minutes of kernels.

#include "math/pack.hpp"
#include "model/assembly_of.hpp"
#include "model/method_dispatch.hpp"

namespace sandglass {

/// All methods are in the first part.
template <class Number, std::size_t part>
ForceOf<Number> assemble_part(const Mesh& mesh, const AnyLaw& any_law, const MethodChoice& choice,
                              const HourglassSettings& settings) {
  ForceOf<Number> elements;
  if constexpr (part == 0 && std::is_same_v<Number, Pack<double>>) {
    const auto make = [&]<class Method, class Law>(const Law& law) {
      if constexpr (knows_law<Method, Law>) {
        elements = std::make_unique<AssemblyOf<Method, Law, Number>>(mesh, law, settings, choice.threads);
      }
    };
    with_method(choice.method, [&]<class Method>() {
      if (const auto* law = std::get_if<NeoHookean>(&any_law)) {
        make.template operator()<Method>(*law);
      } else {
        make.template operator()<Method>(std::get<Viscoelastic<NeoHookean>>(any_law));
      }
    });
  }
  return elements;
}

namespace {

/// Makes the compiler emit all parts, which the dispatch looks through.
template <class Number, std::size_t... part>
auto parts_of(std::index_sequence<part...> /*parts*/) {
  return std::array{&assemble_part<Number, part>...};
}

[[gnu::used]] const auto packs = parts_of<Pack<double>>(std::make_index_sequence<assembly_parts>{});
[[gnu::used]] const auto floats = parts_of<Pack<float>>(std::make_index_sequence<assembly_parts>{});
[[gnu::used]] const auto numbers = parts_of<double>(std::make_index_sequence<assembly_parts>{});

}  // namespace

}  // namespace sandglass
