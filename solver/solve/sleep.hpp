#pragma once

#include "solve/relaxation.hpp"

namespace sandglass {

/// A static answer of which only the moving part was computed.
struct LocalRelaxation {
  Relaxation relaxation;     ///< u of the whole mesh, zero in the sleeping part
  std::size_t elements = 0;  ///< number of awake elements at the end
};

/// Finds the equilibrium of the part of a body that moves. Parts that would move by less than about `share`
/// of the largest imposed displacement sleep: their nodes stay undisplaced, their elements are not computed.
///
/// The extent of the motion is determined under the first, small load, where it takes a few evaluations.
/// Elements around pushed nodes are awake, and a moving node wakes the elements within a third of its
/// distance from the pushed nodes, until none is woken. The error due to the fixed rim is then within the
/// share even if motions decay as slowly as 1/r. Nodes that move by less than half of the share are then
/// fixed, fewer if fixing them changes the motion of the others by more than the share; the remaining part is
/// solved under the full load.
///
/// Observers receive reports on the whole mesh; such a run has no checkpoints. Throws ComputationError like
/// `relax`, and InputError for a condensed method, a refined mesh, or if no displacement or force is imposed.
LocalRelaxation relax_awake(const Scene& scene, const MethodChoice& choice, double share, Observer& observer);

}  // namespace sandglass
