/// Prints how close the bound of the stable step is to the true largest eigenvalue, for every method,
/// undeformed and strongly deformed:
///
///     build/release/verification/sharpness [ELEMENTS [MESHES [SEED]]]
///
/// with so many random elements and meshes for each method and law (see support/sharpness.hpp). Exits with 1
/// if one is unsafe.

#include "support/sharpness.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace sandglass::verification {
namespace {

/// Prints one row of the table; returns the number of unsafe samples.
int print_row(std::string_view label, std::string_view what, Distribution found) {
  fmt::print("{:38} {:18} {:7} {:6}  {:.3f}  {:.3f}  {:.3f}  {:.3f}  {:.3f}\n", label, what, found.samples,
             found.unsafe, found.quantile(0.0), found.quantile(0.05), found.quantile(0.5),
             found.quantile(0.95), found.quantile(1.0));
  return found.unsafe;
}

template <class Pair>
int print_pair(int elements, int meshes, std::uint64_t seed) {
  RandomGeometry random(seed);
  int unsafe = 0;
  for (const bool single : {true, false}) {
    const int samples = single ? elements : meshes;
    if (samples == 0) continue;
    const std::string what = single ? "elements" : "meshes";
    unsafe +=
        print_row(Pair::label(), what + " undeformed", sharpness<Pair>(random, samples, single, undeformed));
    unsafe += print_row(Pair::label(), what + " deformed",
                        sharpness<Pair>(random, samples, single, strongly_deformed));
  }
  return unsafe;
}

template <class... Pairs>
int print_all(TypeList<Pairs...> /*pairs*/, int elements, int meshes, std::uint64_t seed) {
  fmt::print("{:38} {:18} {:>7} {:>6}  {:5}  {:5}  {:5}  {:5}  {:5}\n", "method and law", "true over bound",
             "samples", "unsafe", "min", "5 %", "50 %", "95 %", "max");
  return (print_pair<Pairs>(elements, meshes, seed) + ...);
}

}  // namespace
}  // namespace sandglass::verification

int main(int count, char** words) {
  using namespace sandglass::verification;
  const auto number = [&](int n, int otherwise) { return count > n ? std::atoi(words[n]) : otherwise; };
  const int unsafe = print_all(PairsOf<sandglass::Methods>{}, number(1, 200), number(2, 6),
                               static_cast<std::uint64_t>(number(3, 29)));
  return unsafe == 0 ? 0 : 1;
}
