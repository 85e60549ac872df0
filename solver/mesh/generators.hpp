#pragma once

#include "base/type_list.hpp"
#include "mesh/beam.hpp"
#include "mesh/box.hpp"
#include "mesh/curved_beam.hpp"
#include "mesh/cylinder.hpp"
#include "mesh/ellipsoid.hpp"
#include "mesh/ellipsoidal_cup.hpp"
#include "mesh/spherical_shell.hpp"
#include "mesh/tapered_panel.hpp"

namespace sandglass {

/// The list of mesh generators. A new one is a header, its source and one entry here. Each has name, summary,
/// parameters() and build(), which makes the mesh of its parameters.
using Generators = TypeList<BoxMesh, EllipsoidMesh, CylinderMesh, BeamMesh, CurvedBeamMesh, TaperedPanelMesh,
                            SphericalShellMesh, EllipsoidalCupMesh>;

using AnyGenerator = VariantOf<Generators>;

}  // namespace sandglass
