#pragma once

#include "solve/power_derivatives.hpp"
#include "solve/relaxation.hpp"
#include "solve/static_tangent.hpp"

namespace sandglass {

/// A change of what a static answer depends on; what is empty does not change.
struct Perturbation {
  std::vector<std::vector<double>> parameters =
      {};                   ///< of each material's law, as its parameters() list them
  NodalField forces = {};   ///< N, on all nodes
  NodalField imposed = {};  ///< m; only constrained components count
};

/// The derivatives of a scalar J of an answer.
struct Gradient {
  PowerDerivatives by_elements;  ///< by the parameters of laws, 1/unit, and stiffnesses of elements
  NodalField forces;             ///< by forces on nodes, 1/N; in a motion they follow the case's load
  NodalField imposed;            ///< by imposed displacements, 1/m; zero on components that are free
  NodalField points;             ///< by reference positions of nodes, 1/m; empty if the shape is constant
  NodalField velocities = {};    ///< by initial velocities, s/m; empty for a static answer
  double damping = 0.0;          ///< by the damping proportional to mass, s; of a motion
};

/// Which of the costly derivatives to compute.
struct Wanted {
  bool parameters = true;  ///< of laws
  bool points = false;     ///< reference positions of nodes
};

/// Throws InputError: derivatives do not exist, for the reason `why`, which says what is allowed.
[[noreturn]] void refuse_derivatives(const std::string& why);

/// Throws InputError with the reason why forces have no derivatives that static answers and motions need.
void require_differentiable_forces(const Model& model);

/// Throws InputError, or ComputationError, with the reason why the derivatives of a static answer of a model
/// are not defined or not available.
void require_differentiable(const Model& model, const Relaxation& answer);

/// The derivatives of J by everything that it depends on, from one adjoint problem. `of_displacements` is
/// dJ/du (1/m) at all nodes, `of_reactions` dJ/dR (1/N) for the forces R that hold or drive nodes. Positions
/// of nodes change volumes and areas, thus weights, loads and springs on faces, and the arms of rotations;
/// axes of materials stay.
Gradient gradient(StaticTangent& tangent, const NodalField& of_displacements, const NodalField& of_reactions,
                  const Wanted& wanted = {});

/// The derivative of the displacements (m) along a perturbation, from one linear problem.
NodalField change_of_displacements(StaticTangent& tangent, const Perturbation& perturbation);

}  // namespace sandglass
