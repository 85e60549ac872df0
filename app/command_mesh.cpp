#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/commands.hpp"
#include "app/workspace.hpp"
#include "base/error.hpp"
#include "io/case_file.hpp"
#include "io/foreign_file.hpp"
#include "io/mesh_file.hpp"
#include "mesh/quality.hpp"

namespace sandglass {

namespace {

struct MeshOptions {
  std::string name;
  std::string output;
  ForeignFormat format;
};

/// The format asked for, by name or else by the ending of the file; throws InputError where it is none.
std::string format_of(const MeshOptions& options) {
  std::string name = options.format.name;
  if (name.empty()) {
    name = std::filesystem::path(options.output).extension().string();
    name.erase(0, 1);
    if (name.empty() || name == "hdf5") name = "h5";
  }
  if (name == "h5" || name == "vtu" || name == "xdmf" || name == "inp") return name;
  throw InputError(fmt::format("{}: format '{}'; allowed are h5, vtu, xdmf and inp, as ending or by --format",
                               options.output, name));
}

void print_quality(const QualityTable& table) {
  fmt::print("  scaled Jacobian: {:.3f} to {:.3f}\n", table.smallest, table.largest);
  if (table.counts[0] > 0) fmt::print("    at most 0:  {} elements\n", table.counts[0]);
  for (std::size_t tenth = 1; tenth < table.counts.size(); ++tenth) {
    if (table.counts[tenth] == 0) continue;
    const auto high = static_cast<double>(tenth) / 10.0;
    fmt::print("    {:.1f} to {:.1f}: {} elements\n", high - 0.1, high, table.counts[tenth]);
  }
  if (table.smallest > 0.9995) return;  // all alike in what is shown
  fmt::print("  worst elements, numbered from 0 as in what is written\n");
  for (const auto& [number, quality, centre] : table.worst) {
    fmt::print("    element {}: {:.3f} at ({:.6g}, {:.6g}, {:.6g})\n", number, quality, centre[0], centre[1],
               centre[2]);
  }
}

void write(const Scene& scene, MeshOptions options) {
  options.format.name = format_of(options);
  if (options.format.deck && options.format.name != "inp") {
    throw InputError(
        fmt::format("--deck: for format inp alone; {} is {}", options.output, options.format.name));
  }
  if (options.format.name == "h5") {
    write_mesh_file(scene, options.output);
  } else {
    write_foreign_mesh(scene, options.output, options.format);
  }
}

}  // namespace

void add_mesh_command(CLI::App& app) {
  auto options = std::make_shared<MeshOptions>();
  CLI::App* command =
      app.add_subcommand("mesh", "write the mesh and node sets of a case, and how good it is");
  command->add_option("CASE", options->name, "name or file of the case")->required();
  command->add_option("-o,--output", options->output, "file to write: .h5, .vtu, .xdmf or .inp")->required();
  command->add_option("--format", options->format.name,
                      "h5, vtu, xdmf or inp, where the ending does not say it");
  command->add_flag("--deck", options->format.deck,
                    "of inp: a whole input deck for CalculiX, with material, displacements and forces");
  command->add_option("--element", options->format.element, "of inp: the type of its bricks")
      ->check(CLI::IsMember({"C3D8", "C3D8R", "C3D8I"}))
      ->capture_default_str();
  command->callback([options] {
    const Scene scene = read_scene(find_case(options->name));
    write(scene, *options);
    const QualityTable quality = quality_table(scene.mesh);
    fmt::print("{}: {} nodes, {} elements, smallest scaled Jacobian {:.3f}\n", options->output,
               scene.mesh.points.size(), scene.mesh.cells.size(), quality.smallest);
    print_quality(quality);
    for (const auto& [name, nodes] : scene.sets) fmt::print("  set {}: {} nodes\n", name, nodes.size());
    for (const auto& [name, elements] : scene.element_sets) {
      fmt::print("  element set {}: {} elements\n", name, elements.size());
    }
  });
}

}  // namespace sandglass
