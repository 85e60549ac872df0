#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "problem/observer.hpp"

namespace sandglass {

/// What a checkpoint belongs to: names and values, all of which a run that goes on from it must share.
using Identity = std::vector<std::pair<std::string, std::string>>;

/// A run on its way: what it has told, and the point from which it goes on.
struct RunSoFar {
  std::vector<Frame> frames;
  std::vector<HistoryRow> history;
  Checkpoint point;
};

/// Writes a checkpoint: an HDF5 file behind a checksum, with /state/*, /frames/NNNN as a result file has
/// them, /history and the identity as attributes. The file is replaced as a whole or not at all. Throws
/// InputError or ComputationError when that fails.
void write_checkpoint_file(const std::filesystem::path& path, const Identity& identity, const RunSoFar& run);

/// Reads it for a mesh of this number of nodes and elements. Throws InputError when the file is damaged, and
/// when its identity is another: the text tells all that differs.
RunSoFar read_checkpoint_file(const std::filesystem::path& path, const Identity& identity,
                              std::size_t n_nodes, std::size_t n_elements);

}  // namespace sandglass
