#include "comparison/reference_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "io/hdf5_file.hpp"
#include "io/mesh_file.hpp"

namespace sandglass {

namespace {

void require_hash(const Hdf5File& file, const std::string& attribute, const std::string& expected,
                  const Scene& scene) {
  const std::string found = file.read_text_attribute("/", attribute);
  if (found == expected) return;
  throw InputError(
      fmt::format("{}: {} is {}, but the case {} has {}; the file was made for another {}. Regenerate it: "
                  "reference/regenerate {}",
                  file.path().string(), attribute, found, scene.settings.file.string(), expected,
                  attribute == "mesh_hash" ? "mesh" : "case", scene.settings.name));
}

/// Throws InputError unless the answers of a motion are stored for the times of the scene's frames.
void require_times(const Hdf5File& file, const std::vector<double>& expected, const Scene& scene) {
  const auto found = file.read<double>("/times");
  const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-12 * b; };
  if (std::equal(found.entries.begin(), found.entries.end(), expected.begin(), expected.end(), same)) return;
  throw InputError(
      fmt::format("{}: has {} times, which are not the ends of the {} frames of {}. Regenerate it: "
                  "reference/regenerate {}",
                  file.path().string(), found.entries.size(), expected.size(), scene.settings.file.string(),
                  scene.settings.name));
}

}  // namespace

OwnError read_own_error(const std::filesystem::path& path) {
  const auto file = Hdf5File::open(path);
  if (!file.has_attribute("/", "own_error_max")) return {{}, "not stored in its file"};
  const double largest = file.read_number_attribute("/", "own_error_max");
  return {std::isfinite(largest) ? std::optional(largest) : std::nullopt,
          file.read_text_attribute("/", "own_error_note")};
}

std::vector<double> answer_times(const CaseSettings& settings) {
  if (settings.quasi_static) return {1.0};
  std::vector<double> times;
  const DynamicsSettings& motion = settings.dynamics;
  for (int n = 1; n <= motion.frames; ++n) times.push_back(motion.duration * n / motion.frames);
  return times;
}

Displacements read_reference(const std::filesystem::path& path, const Scene& scene) {
  const auto file = Hdf5File::open(path);
  require_hash(file, "case_hash", scene.case_hash, scene);
  require_hash(file, "mesh_hash", scene.mesh_hash, scene);
  if (scene.settings.quasi_static) {
    return {read_nodal_field(file, "/displacement", scene.mesh.points.size())};
  }
  const std::vector<double> times = answer_times(scene.settings);
  require_times(file, times, scene);
  Displacements u;
  for (std::size_t t = 0; t < times.size(); ++t) {
    u.push_back(read_nodal_field(file, fmt::format("/displacement/{:04}", t + 1), scene.mesh.points.size()));
  }
  return u;
}

}  // namespace sandglass
