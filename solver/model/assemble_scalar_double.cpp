#include "model/method_dispatch.hpp"

namespace sandglass {

std::unique_ptr<InternalForce<double>> make_scalar_double(const Mesh& mesh, const AnyLaw& law,
                                                          const MethodChoice& choice, double density) {
  return assemble<double>(mesh, law, choice, density);
}

}  // namespace sandglass
