#pragma once

#include "benchmark/stepped_model.hpp"

namespace sandglass {

/// A condensed method that repeats its update: from displacements of the driven sets to those of all nodes
/// and the forces on the sets. The scene must outlive it.
std::unique_ptr<SteppedModel> make_condensed_model(const Scene& scene, const MethodChoice& choice);

}  // namespace sandglass
