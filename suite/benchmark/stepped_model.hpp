#pragma once

#include <memory>

#include "benchmark/own_motion.hpp"
#include "benchmark/roofline.hpp"
#include "mesh/quality.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// A box of about this number of elements of the paper's soft tissue (E = 3000 Pa, nu = 0.49, 1000 kg/m^3),
/// clamped at z = 0 and moved at its other end. The elements are cubes or, for `Shapes::any`, cubes whose
/// inner nodes have moved by up to a tenth of an edge.
Scene box_scene(int elements, Shapes shapes = Shapes::any);

/// The shortest distance between two nodes of an element, m.
double element_size(const Scene& scene);

/// Displacements (m) that strain every element of any mesh by a few percent and excite its hourglass modes:
/// waves some elements long and 3 % of the element size high.
NodalField wavy_field(const Scene& scene);

/// A model that takes the steps of a dynamic run, starting from these waves. Steps are 0.9 of the stable one
/// and damped, so that the motion stays bounded. A condensed method repeats its update instead: displacements
/// of all nodes and forces on the driven sets. The scene must outlive it.
class SteppedModel : public Steppable {
 public:
  /// Operations and bytes of a step, per element.
  virtual Work work() const = 0;
};

/// Forces (N) after three steps to a field of displacements (m), the same for all.
template <class Real>
NodalField forces_on_the_way(const InternalForce<Real>& elements, const NodalField& field);

/// After a motion that did not fail, steps start from its end, under the full load, instead of from the
/// waves, once with each of its sets of levels. A condensed method has no steps and needs neither.
std::unique_ptr<SteppedModel> make_stepped_model(const Scene& scene, const MethodChoice& choice,
                                                 const OwnMotion* motion = nullptr);

}  // namespace sandglass
