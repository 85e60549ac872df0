#include "model/method_dispatch.hpp"

namespace sandglass {

std::unique_ptr<InternalForce<double>> make_scalar_double(const Mesh& mesh, const AnyLaw& law,
                                                          const MethodChoice& choice) {
  return assemble<double>(mesh, law, choice);
}

}  // namespace sandglass
