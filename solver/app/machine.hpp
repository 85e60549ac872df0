#pragma once

#include "io/result_file.hpp"

namespace sandglass {

/// Where a figure comes from: processor, revision, compiler and flags.
Provenance build_provenance();

}  // namespace sandglass
