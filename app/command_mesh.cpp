#include <fmt/format.h>

#include <memory>

#include "app/commands.hpp"
#include "app/deck_file.hpp"
#include "app/foreign_files.hpp"
#include "app/scene_report.hpp"
#include "app/workspace.hpp"
#include "base/error.hpp"
#include "comparison/mesh_quality.hpp"
#include "io/case_file.hpp"
#include "io/mesh_file.hpp"
#include "io/new_file.hpp"

namespace sandglass {

namespace {

struct MeshOptions {
  std::string name;
  std::string output;
  std::string format;
  DeckOptions deck;
};

/// The requested format, by name or else by the file's extension. Throws InputError for an unknown one.
std::string format_of(const MeshOptions& options) {
  std::string name = options.format;
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
  if (table.smallest > 0.9995) return;  // all would be printed as 1.000
  fmt::print("  worst elements, numbered from 0 as in the file\n");
  for (const auto& [number, quality, centre] : table.worst) {
    fmt::print("    element {}: {:.3f} at ({:.6g}, {:.6g}, {:.6g})\n", number, quality, centre[0], centre[1],
               centre[2]);
  }
}

void write(const Scene& scene, const MeshOptions& options) {
  if (!options.deck.program.empty()) return write_deck(scene, options.output, options.deck);
  const std::string format = format_of(options);
  if (format == "h5") return write_mesh_file(scene, options.output);
  write_foreign_mesh(scene, options.output, format);
}

}  // namespace

void add_mesh_command(CLI::App& app) {
  auto options = std::make_shared<MeshOptions>();
  CLI::App* command = app.add_subcommand(
      "mesh", "write the mesh and node sets of a case, and print the quality of its elements");
  command->add_option("CASE", options->name, "name or file of the case")->required();
  command->add_option("-o,--output", options->output, "file to write: .h5, .vtu, .xdmf, .inp, or a deck")
      ->required();
  auto* format = command->add_option("--format", options->format,
                                     "h5, vtu, xdmf or inp; default: from the file's extension");
  auto* deck = command
                   ->add_option("--deck", options->deck.program,
                                "write a complete input for this program: calculix, febio, niftysim "
                                "or openradioss (exchange/README.md)")
                   ->excludes(format);
  command->add_option("--element", options->deck.element, "for a deck: the program's name of the element")
      ->needs(deck);
  command
      ->add_option("--hourglass", options->deck.hourglass,
                   "for a deck: the program's hourglass coefficient; default: its usual one")
      ->needs(deck);
  command->callback([options] {
    const CaseOnMesh problem = with_mesh(find_case(options->name));
    const Scene scene = make_scene(problem);
    require_place(options->output, scene.settings.files);
    write(scene, *options);
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
