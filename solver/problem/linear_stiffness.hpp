#pragma once

#include <functional>

#include "problem/model.hpp"

namespace sandglass {

/// Stiffness of one element, N/m; row and column 3 I + i for component i at node I.
using ElementStiffness = Matrix<double, 24, 24>;

/// Calls visit(cell, K) for each element of a model whose method is linear, f = K u: the columns of K are the
/// forces of the method's own kernel at unit displacements. Throws InputError if the method is not linear or
/// the law has a history.
void for_each_stiffness(const Model& model,
                        const std::function<void(const Hexahedron&, const ElementStiffness&)>& visit);

}  // namespace sandglass
