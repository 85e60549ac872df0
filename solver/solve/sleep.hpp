#pragma once

#include "solve/relaxation.hpp"

namespace sandglass {

/// A static answer of which only the part that moves was computed.
struct LocalRelaxation {
  Relaxation relaxation;     ///< u of the whole mesh: zero where it sleeps
  std::size_t elements = 0;  ///< that were awake in the end
};

/// Finds the displacements at which the forces balance where a body moves; what would move by less than about
/// `share` of the largest imposed displacement sleeps: its nodes are held at rest, its elements are not
/// computed.
///
/// How far a motion reaches is seen under the first, small load, where it costs a few evaluations: around
/// what is pushed all is awake, and a node that moves keeps awake the elements as far around it as a third of
/// its own distance from what is pushed, until nobody is woken. The motion that was held at the rim is then
/// within the share even where motions fall off as slowly as 1/r. Of this motion what stays below half of the
/// share is held, less if holding it changes the others by more than the share; the rest is brought to rest
/// under the whole load. Where nodes far away then move farther than under the first load, all that is done
/// again for a share that is smaller by that factor.
///
/// Observers hear of the whole mesh; such a run is not kept in checkpoints. Throws ComputationError as
/// `relax` does, and InputError for a method that answers by condensation and where nothing pushes.
LocalRelaxation relax_awake(const Scene& scene, const MethodChoice& choice, double share, Observer& observer);

}  // namespace sandglass
