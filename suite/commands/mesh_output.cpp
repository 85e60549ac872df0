#include "commands/mesh_output.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "commands/foreign_files.hpp"
#include "io/mesh_file.hpp"

namespace sandglass {

namespace {

/// The requested format, by name or else by the file's extension. Throws InputError for an unknown one.
std::string format_of(const std::filesystem::path& output, std::string name) {
  if (name.empty()) {
    name = output.extension().string();
    name.erase(0, 1);
    if (name.empty() || name == "hdf5") name = "h5";
  }
  if (name == "h5" || name == "vtu" || name == "xdmf" || name == "inp") return name;
  throw InputError(fmt::format("{}: format '{}'; allowed are h5, vtu, xdmf and inp, as ending or by --format",
                               output.string(), name));
}

}  // namespace

void write_mesh_of(const Scene& scene, const std::filesystem::path& output, const MeshFormat& as) {
  if (!as.deck.program.empty()) return write_deck(scene, output, as.deck);
  const std::string format = format_of(output, as.format);
  if (format == "h5") return write_mesh_file(scene, output);
  write_foreign_mesh(scene, output, format);
}

}  // namespace sandglass
