#include "model/method_dispatch.hpp"

namespace sandglass {

std::unique_ptr<InternalForce<double>> make_packed_double(const Mesh& mesh, const AnyLaw& law,
                                                          const MethodChoice& choice, double density) {
  return assemble<Pack<double>>(mesh, law, choice, density);
}

}  // namespace sandglass
