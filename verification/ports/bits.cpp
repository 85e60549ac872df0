/// Prints properties of a compiler and a processor: the lanes of a pack, whether products and sums are
/// contracted to one rounding, and a hash of the bits of forces. Two programs are built from this file, the
/// second without contraction.

#include <fmt/format.h>

#include <bit>
#include <cstdint>

#include "element/methods.hpp"
#include "math/pack.hpp"
#include "support/nodal_form.hpp"
#include "support/random_hexahedra.hpp"

namespace sandglass::verification {
namespace {

using Kernel = NodalForm<FormulationOf<TlPerturbation, NeoHookean>>;

/// FNV-1a over the forces of a hundred distorted elements.
std::uint64_t hash_of_forces() {
  RandomGeometry random(1);
  const NeoHookean law{.young_modulus = 3000.0, .poisson_ratio = 0.49};
  std::uint64_t hash = 14695981039346656037U;
  for (int sample = 0; sample < 100; ++sample) {
    const NodalVectors<double> X = random.hexahedron();
    const auto element = Kernel::precompute(X, law, {});
    const NodalVectors<double> u = X * random.tensor(0.1);
    const auto force = Kernel::force(u, element, law);
    for (const double entry : force.entries) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(entry)) * 1099511628211U;
    }
  }
  return hash;
}

/// Whether a b - c has a single rounding: for c = a b rounded, it then is the rounding error.
bool contracts() {
  volatile double a = 1.0 / 3.0;
  volatile double c = a * a;
  return a * a - c != 0.0;
}

}  // namespace
}  // namespace sandglass::verification

int main() {
  using namespace sandglass;
  fmt::print("packs of {} doubles, {} floats; contraction {}; forces {:016x}\n", native_width<double>,
             native_width<float>, verification::contracts() ? "yes" : "no ", verification::hash_of_forces());
}
