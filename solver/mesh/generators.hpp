#pragma once

#include "base/type_list.hpp"
#include "mesh/box.hpp"
#include "mesh/cylinder.hpp"
#include "mesh/ellipsoid.hpp"

namespace sandglass {

/// THE list of mesh generators. A new one is a header, its source and one entry here.
using Generators = TypeList<BoxMesh, EllipsoidMesh, CylinderMesh>;

using AnyGenerator = VariantOf<Generators>;

}  // namespace sandglass
