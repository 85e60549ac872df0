#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "comparison/accuracy.hpp"
#include "problem/model.hpp"

namespace sandglass {

/// The times (s) at which the answer of a case is told: the ends of the frames of a motion; of an answer at
/// rest one, where the load is full.
std::vector<double> answer_times(const CaseSettings& settings);

/// Displacements (m) of a stored golden or truth at the nodes of the scene and the times of its answer.
/// Throws InputError when the file is missing or broken, and when its hashes or times are not those of the
/// scene; the text names the command that makes it again.
Displacements read_reference(const std::filesystem::path& path, const Scene& scene);

/// What a stored answer says of its own error.
struct OwnError {
  std::optional<double> largest;  ///< over all nodes, as a fraction of the unit; none where it was not
                                  ///< estimated
  std::string note;               ///< how it was estimated, or why not
};

/// The own error of a stored golden or truth. Throws InputError when the file is missing or broken.
OwnError read_own_error(const std::filesystem::path& path);

}  // namespace sandglass
