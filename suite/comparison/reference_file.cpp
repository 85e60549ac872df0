#include "comparison/reference_file.hpp"

#include <fmt/format.h>

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
      fmt::format("{}: {} is {}, but the case {} has {}; the file was made for another {}. Make it anew: "
                  "reference/regenerate {}",
                  file.path().string(), attribute, found, scene.description.file.string(), expected,
                  attribute == "mesh_hash" ? "mesh" : "case", scene.description.name));
}

}  // namespace

OwnError read_own_error(const std::filesystem::path& path) {
  const auto file = Hdf5File::open(path);
  if (!file.has_attribute("/", "own_error_max")) return {{}, "the file does not tell it"};
  const double largest = file.read_number_attribute("/", "own_error_max");
  return {std::isfinite(largest) ? std::optional(largest) : std::nullopt,
          file.read_text_attribute("/", "own_error_note")};
}

NodalField read_reference(const std::filesystem::path& path, const Scene& scene) {
  const auto file = Hdf5File::open(path);
  require_hash(file, "case_hash", scene.case_hash, scene);
  require_hash(file, "mesh_hash", scene.mesh_hash, scene);
  return read_nodal_field(file, "/displacement", scene.mesh.points.size());
}

}  // namespace sandglass
