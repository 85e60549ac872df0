#pragma once

#include <memory>

#include "base/ranks.hpp"

namespace sandglass {

/// The ranks of this run: MPI's if the program was built with it (SANDGLASS_MPI), else one. Throws InputError
/// if mpirun starts several processes of a program without MPI, as each would do all the work.
std::shared_ptr<const Ranks> join_ranks();

/// Warns on standard error if mpirun has bound this process, the first one, to fewer processors than it has
/// threads.
void warn_if_bound(const Ranks& ranks, int threads);

}  // namespace sandglass
