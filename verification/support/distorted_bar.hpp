#pragma once

#include <gtest/gtest.h>

#include "solve/condensed_response.hpp"
#include "solve/relaxation.hpp"
#include "support/random_hexahedra.hpp"
#include "support/scenes.hpp"

/// A small scene without symmetry for comparing linear methods.
namespace sandglass::verification {

/// A bar of `fineness` times 3 x 3 x 8 distorted elements between a foot and a head that moves by d.
inline CaseOnMesh distorted_bar_case(const Vector& d, std::array<bool, 3> components = {true, true, true},
                                     int fineness = 1) {
  Case description = plain_case(NeoHookean{.young_modulus = 3000.0, .poisson_ratio = 0.49});
  Mesh mesh = box({0.1, 0.1, 0.3}, {3 * fineness, 3 * fineness, 8 * fineness});
  const NodeSets sets{{"foot", nodes_where(mesh.points, [](const Vector& X) { return X[2] == 0.0; })},
                      {"head", nodes_where(mesh.points, [](const Vector& X) { return X[2] > 0.299; })}};
  RandomGeometry random(37);
  for (auto& X : mesh.points) {
    for (auto& x : X) x += random.uniform(-0.006, 0.006) / fineness;
  }
  description.displacements = {{"foot", {}}, {"head", d, components}};
  description.relaxation.tolerance = 1e-12;
  return {description, mesh, sets};
}

inline Scene distorted_bar(const Vector& d, std::array<bool, 3> components = {true, true, true},
                           int fineness = 1) {
  return make_scene(distorted_bar_case(d, components, fineness));
}

inline NodalField relaxed(const Scene& scene, const MethodChoice& choice) {
  Observer silent;
  const Relaxation answer = relax(Model(scene, choice), silent);
  EXPECT_TRUE(answer.converged);
  return answer.u;
}

inline CondensedResponse<double> response_of_sets(const Scene& scene,
                                                  const MethodChoice& choice = {"linear-condensed"}) {
  return {Model(scene, choice), handles_of_sets(scene), all_nodes(scene)};
}

}  // namespace sandglass::verification
