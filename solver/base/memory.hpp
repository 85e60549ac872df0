#pragma once

#include <cstddef>

namespace sandglass {

/// Bytes of memory that new data may take without harm to others, at most what a limit of the shell allows.
std::size_t available_memory();

/// What is done with a mesh.
enum class MeshUse { storing, motion, equilibrium };

/// Bytes of memory that a number of elements needs, about: what boxes of 128,000 elements took at most with
/// tl-perturbation in double; the search for equilibrium keeps coarser meshes too.
double memory_needed(double elements, MeshUse use);

/// Throws ComputationError, before the memory is taken, if a number of elements needs more than is available.
void require_memory(double elements, MeshUse use);

}  // namespace sandglass
