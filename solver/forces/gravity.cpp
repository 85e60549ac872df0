#include "forces/gravity.hpp"

namespace sandglass {

void Gravity::resolve(ForceResolver& resolver) const {
  resolver.add_by_mass(resolver.number_of(curve),
                       [g = value]<class T>(const Triple<T>&) { return from_double<T>(Triple<double>{g}); });
}

}  // namespace sandglass
