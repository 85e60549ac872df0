#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/commands.hpp"
#include "app/workspace.hpp"
#include "io/case_file.hpp"
#include "io/mesh_file.hpp"
#include "mesh/quality.hpp"

namespace sandglass {

void add_mesh_command(CLI::App& app) {
  struct Options {
    std::string name;
    std::string output;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("mesh", "write the mesh and node sets of a case");
  command->add_option("CASE", options->name, "name or file of the case")->required();
  command->add_option("-o,--output", options->output, "HDF5 file to write")->required();
  command->callback([options] {
    const Scene scene = read_scene(find_case(options->name));
    write_mesh_file(scene, options->output);
    double quality = 1.0;
    for (const auto& cell : scene.mesh.cells) {
      quality = std::min(quality, scaled_jacobian(gather(scene.mesh.points, cell)));
    }
    fmt::print("{}: {} nodes, {} elements, smallest scaled Jacobian {:.3f}\n", options->output,
               scene.mesh.points.size(), scene.mesh.cells.size(), quality);
    for (const auto& [name, nodes] : scene.sets) fmt::print("  set {}: {} nodes\n", name, nodes.size());
  });
}

}  // namespace sandglass
