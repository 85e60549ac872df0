#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "problem/model.hpp"
#include "problem/observer.hpp"

namespace sandglass {

/// The identity of a checkpoint: names and values, all of which must agree with the run that resumes from it.
using Identity = std::vector<std::pair<std::string, std::string>>;

/// What checkpoints of a model agree in: case, mesh and method.
Identity identity_of(const Model& model);

/// An unfinished run: everything reported so far, and the point from which to resume.
struct RunSoFar {
  std::vector<Frame> frames;
  std::vector<HistoryRow> history;
  Checkpoint point;
};

/// Writes a checkpoint: a checksum followed by an HDF5 file with /state/*, /frames/NNNN as in a result file,
/// /history and the identity as attributes. The file is replaced as a whole or not at all. Throws InputError
/// or ComputationError if that fails.
void write_checkpoint_file(const std::filesystem::path& path, const Identity& identity, const RunSoFar& run);

/// Reads it for a mesh of this number of nodes and elements. Throws InputError if the file is damaged or its
/// identity differs; the message lists all differences.
RunSoFar read_checkpoint_file(const std::filesystem::path& path, const Identity& identity,
                              std::size_t n_nodes, std::size_t n_elements);

}  // namespace sandglass
