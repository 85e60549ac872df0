#pragma once

#include "io/checkpoint_file.hpp"
#include "io/result_file.hpp"

namespace sandglass {

/// Where a figure comes from: processor, revision, compiler and flags.
Provenance build_provenance();

/// What makes this program give the bits that it gives: revision, compiler, flags, and a hash of the program
/// itself where the system shows it.
Identity program_identity();

}  // namespace sandglass
