#pragma once

#include "io/checkpoint_file.hpp"
#include "io/result_file.hpp"

namespace sandglass {

/// The origin of a figure: processor, revision, compiler and flags.
Provenance build_provenance();

/// Everything on which the bits of an answer depend: revision, compiler, flags, and a hash of the executable
/// if the system provides its path.
Identity program_identity();

}  // namespace sandglass
