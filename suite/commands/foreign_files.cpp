#include "commands/foreign_files.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "io/foreign_file.hpp"
#include "io/mesh_file.hpp"
#include "io/new_file.hpp"
#include "io/temporary_folder.hpp"

namespace sandglass {

void write_foreign_mesh(const Scene& scene, const std::filesystem::path& path, const std::string& format) {
  if (!scene.ties.empty()) {
    throw InputError(fmt::format("{}: a refined mesh has hanging nodes, which only .h5 can hold",
                                 scene.settings.file.string()));
  }
  NewFile output(path);
  const TemporaryFolder folder;
  const auto source = folder / "mesh.h5";
  write_mesh_file(scene, source);
  run_converter({"write", source.string(), output.temporary().string(), "--format", format}, path);
  output.commit();
}

NodalField read_foreign_displacement(const std::filesystem::path& path, const Scene& scene,
                                     const NodeMatching& matching) {
  const TemporaryFolder folder;
  const auto mesh = folder / "mesh.h5", matched = folder / "displacement.h5";
  write_mesh_file(scene, mesh);
  std::vector<std::string> arguments{"displacement",   as_argument(path), mesh.string(),
                                     matched.string(), "--tolerance",     fmt::to_string(matching.tolerance)};
  if (!matching.field.empty()) arguments.push_back("--field=" + matching.field);
  run_converter(std::move(arguments), path);
  return read_nodal_field(Hdf5File::open(matched), "/displacement", scene.mesh.points.size());
}

}  // namespace sandglass
