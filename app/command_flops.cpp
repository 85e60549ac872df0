#include <fmt/format.h>

#include <memory>

#include "app/commands.hpp"
#include "app/machine.hpp"
#include "commands/flops.hpp"
#include "io/new_file.hpp"
#include "io/text_file.hpp"
#include "material/laws.hpp"

namespace sandglass {

namespace {

/// "add mul div special total", right-aligned.
std::string columns(const Operations& n) {
  return fmt::format("{:>6}{:>6}{:>6}{:>9}{:>7}", n.add, n.mul, n.div, n.special, n.total());
}

}  // namespace

void add_flops_command(CLI::App& app) {
  auto json = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "flops", "print the operations per element and step, counted by running the kernels");
  command->add_option("--json", *json, "write every count to this file");
  command->callback([json] {
    if (!json->empty()) require_place(*json);
    auto rows = count_methods();
    fmt::print(
        "operations per element and step with the law {}; bytes: constants in double, places of nodes, "
        "history;\n"
        "of a condensed method, what an update takes per node and driven set\n"
        "{:<25}{:<16}{:<10}{:>6}{:>6}{:>6}{:>9}{:>7}{:>7}\n",
        NeoHookean::name, "method", "form", "part", "add", "mul", "div", "special", "total", "bytes");
    for (const auto& row : rows) {
      fmt::print("{:<25}{:<16}{:<10}{}{:>7}\n", row.method, row.form, row.part, columns(row.operations),
                 row.bytes > 0 ? fmt::to_string(row.bytes) : "");
    }
    const auto laws = count_laws();
    fmt::print("\noperations of the laws per point and step\n{:<43}{:>6}{:>6}{:>6}{:>9}{:>7}\n", "law", "add",
               "mul", "div", "special", "total");
    for (const auto& row : laws) fmt::print("{:<43}{}\n", row.law, columns(row.operations));
    rows.insert(rows.end(), laws.begin(), laws.end());
    const auto programs = count_programs();
    fmt::print(
        "\nthe force of an element as a straight-line program (`sandglass kernels`), equal operations shared:"
        "\ninstructions with products and sums fused; the longest chain; values alive at once;"
        "\nthe share of the peak that this mix of operations allows\n{:<25}{:>11}{:>13}{:>7}{:>7}{:>7}\n",
        "method", "operations", "instructions", "chain", "alive", "peak");
    for (const auto& [method, shape] : programs) {
      fmt::print("{:<25}{:>11}{:>13}{:>7}{:>7}{:>5.0f} %\n", method, shape.operations, shape.instructions(),
                 shape.chain, shape.alive, 100.0 * shape.peak_share());
    }
    if (!json->empty()) write_text_file(*json, to_json(build_provenance(), rows, programs));
  });
}

}  // namespace sandglass
