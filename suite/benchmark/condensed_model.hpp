#pragma once

#include "benchmark/stepped_model.hpp"

namespace sandglass {

/// The largest number of nodes for which condensed methods are timed. Set-up is repeated for each variant and
/// takes seconds for a cube of this size; the work grows with the number to the power of 7/3.
inline constexpr std::size_t most_condensed_nodes = 10000;

/// A condensed method that repeats its update: from displacements of the driven sets to displacements of all
/// nodes and forces on the sets. The scene must outlive it.
std::unique_ptr<SteppedModel> make_condensed_model(const Scene& scene, const MethodChoice& choice);

}  // namespace sandglass
