#include <fmt/format.h>

#include <memory>

#include "app/commands.hpp"
#include "app/scene_report.hpp"
#include "commands/mesh_output.hpp"
#include "commands/workspace.hpp"
#include "comparison/mesh_quality.hpp"
#include "io/case_file.hpp"
#include "io/new_file.hpp"

namespace sandglass {

namespace {

struct MeshOptions {
  std::string name;
  std::string output;
  MeshFormat as;
};

void print_quality(const QualityTable& table) {
  fmt::print("  scaled Jacobian: {:.3f} to {:.3f}\n", table.smallest, table.largest);
  if (table.counts[0] > 0) fmt::print("    at most 0:  {} elements\n", table.counts[0]);
  for (std::size_t tenth = 1; tenth < table.counts.size(); ++tenth) {
    if (table.counts[tenth] == 0) continue;
    const auto high = static_cast<double>(tenth) / 10.0;
    fmt::print("    {:.1f} to {:.1f}: {} elements\n", high - 0.1, high, table.counts[tenth]);
  }
  if (table.smallest > 0.9995) return;  // all would be printed as 1.000
  fmt::print("  worst elements, numbered from 0 as in the file\n");
  for (const auto& [number, quality, centre] : table.worst) {
    fmt::print("    element {}: {:.3f} at ({:.6g}, {:.6g}, {:.6g})\n", number, quality, centre[0], centre[1],
               centre[2]);
  }
}

}  // namespace

void add_mesh_command(CLI::App& app) {
  auto options = std::make_shared<MeshOptions>();
  CLI::App* command = app.add_subcommand(
      "mesh", "write the mesh and node sets of a case, and print the quality of its elements");
  command->add_option("CASE", options->name, "name or file of the case")->required();
  command->add_option("-o,--output", options->output, "file to write: .h5, .vtu, .xdmf, .inp, or a deck")
      ->required();
  auto* format = command->add_option("--format", options->as.format,
                                     "h5, vtu, xdmf or inp; default: from the file's extension");
  auto* deck = command
                   ->add_option("--deck", options->as.deck.program,
                                "write a complete input for this program: calculix, febio, niftysim "
                                "or openradioss (exchange/README.md)")
                   ->excludes(format);
  command->add_option("--element", options->as.deck.element, "for a deck: the program's name of the element")
      ->needs(deck);
  command
      ->add_option("--hourglass", options->as.deck.hourglass,
                   "for a deck: the program's hourglass coefficient; default: its usual one")
      ->needs(deck);
  command->callback([options] {
    const CaseOnMesh problem = with_mesh(find_case(options->name));
    const Scene scene = make_scene(problem);
    require_place(options->output, scene.settings.files);
    write_mesh_of(scene, options->output, options->as);
    const QualityTable quality = quality_table(scene.mesh);
    fmt::print("{}: {} nodes, {} elements, smallest scaled Jacobian {:.3f}\n", options->output,
               scene.mesh.points.size(), scene.mesh.cells.size(), quality.smallest);
    print_quality(quality);
    print_sets(problem.description, scene);
    print_understood(problem, scene);
    if (scene.settings.quasi_static) print_free_motions(scene);
  });
}

}  // namespace sandglass
