#pragma once

#include <cstdint>

#include "base/ranks.hpp"

namespace sandglass {

/// The ranks of this run: those of MPI in a program that was built with it (SANDGLASS_MPI), else one. Throws
/// InputError if mpirun starts several processes of a program without MPI: each would do the whole work.
std::shared_ptr<const Ranks> join_ranks();

/// Lets all ranks write one HDF5 file: sets its access list, and the transfer list of each write.
void open_together(const Ranks& ranks, std::int64_t access);
void write_together(const Ranks& ranks, std::int64_t transfer);

}  // namespace sandglass
