#pragma once

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

/// The derivatives of a scalar J of a static answer.
struct Gradient {
  std::vector<std::vector<double>> parameters;  ///< by the parameters of each material's law, 1/unit
  std::vector<double> scales;  ///< by a factor of the stiffness of each element, at the factor one
  NodalField forces;           ///< by forces on nodes, 1/N
  NodalField imposed;          ///< by imposed displacements, 1/m; zero on components that are free
  NodalField points;           ///< by reference positions of nodes, 1/m; empty if the shape is constant
};

/// Whether derivatives by the reference positions of nodes are wanted.
enum class Shape { constant, varies };

/// Throws InputError, or ComputationError, with the reason why the derivatives of a static answer of a model
/// are not defined or not available.
void require_differentiable(const Model& model, const Relaxation& answer);

/// The derivatives of J by everything that it depends on, from one adjoint problem. `of_displacements` is
/// dJ/du (1/m) at all nodes, `of_reactions` dJ/dR (1/N) for the forces R that hold or drive nodes. Positions
/// of nodes change volumes and areas, thus weights, loads and springs on faces, and the arms of rotations;
/// axes of materials stay.
Gradient gradient(StaticTangent& tangent, const NodalField& of_displacements, const NodalField& of_reactions,
                  Shape shape = Shape::constant);

/// The derivative of the displacements (m) along a perturbation, from one linear problem.
NodalField change_of_displacements(StaticTangent& tangent, const Perturbation& perturbation);

/// The names of the parameters of a law, in their order.
std::vector<std::string_view> parameter_names(const AnyLaw& law);

}  // namespace sandglass
