#pragma once

#include "benchmark/stepped_model.hpp"

namespace sandglass {

/// Nodes of a scene up to which condensed methods are set up to be timed, again for each variant: some
/// seconds for a cube of this size; the work grows with their number to the power of 7/3.
inline constexpr std::size_t most_condensed_nodes = 10000;

/// A condensed method that repeats its update: from displacements of the driven sets to those of all nodes
/// and the forces on the sets. The scene must outlive it.
std::unique_ptr<SteppedModel> make_condensed_model(const Scene& scene, const MethodChoice& choice);

}  // namespace sandglass
