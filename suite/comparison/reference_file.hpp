#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "comparison/accuracy.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// The times (s) for which the answer of a case is stored: the ends of the frames of a motion; for a static
/// answer only the full load.
std::vector<double> answer_times(const CaseSettings& settings);

/// Displacements (m) of a stored golden or truth at the nodes of the scene and the times of its answer.
/// Throws InputError if the file is missing or broken, or if its hashes or times differ from the scene's; the
/// message names the command that regenerates it.
Displacements read_reference(const std::filesystem::path& path, const Scene& scene);

/// The own error of a stored answer.
struct OwnError {
  std::optional<double> largest;  ///< over all nodes, as a fraction of the unit; none if not estimated
  std::string note;               ///< how it was estimated, or why not
};

/// The own error of a stored golden or truth. Throws InputError if the file is missing or broken.
OwnError read_own_error(const std::filesystem::path& path);

}  // namespace sandglass
