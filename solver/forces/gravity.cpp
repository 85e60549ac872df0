#include "forces/gravity.hpp"

#include <numeric>

namespace sandglass {

void Gravity::resolve(ForceResolver& resolver) const {
  const std::vector<double>& masses = resolver.masses;
  resolver.sizes_of_dead.push_back({length(value) * std::accumulate(masses.begin(), masses.end(), 0.0), 0.0});
  const std::size_t number = resolver.number_of(curve);
  for (std::size_t n = 0; n < masses.size(); ++n)
    resolver.add_dead(number, static_cast<int>(n), value, masses[n]);
}

}  // namespace sandglass
