#include "model/method_dispatch.hpp"

namespace sandglass {

std::unique_ptr<InternalForce<float>> make_packed_float(const Mesh& mesh, const AnyLaw& law,
                                                        const MethodChoice& choice, double density) {
  return assemble<Pack<float>>(mesh, law, choice, density);
}

}  // namespace sandglass
