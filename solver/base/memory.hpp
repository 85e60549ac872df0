#pragma once

#include <cstddef>

namespace sandglass {

/// Bytes of memory available for new data, within the limits of the shell.
std::size_t available_memory();

/// The use of a mesh.
enum class MeshUse { storing, motion, equilibrium };

/// Approximate bytes of memory for a number of elements: the most that boxes of 128,000 elements took with
/// tl-perturbation in double; the search for equilibrium also keeps coarser meshes.
double memory_needed(double elements, MeshUse use);

/// Throws ComputationError, before memory is allocated, if a number of elements needs more than is available.
void require_memory(double elements, MeshUse use);

}  // namespace sandglass
