#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/workspace.hpp"
#include "io/case_file.hpp"

namespace sandglass {

void add_cases_command(CLI::App& app) {
  app.add_subcommand("cases", "list the canonical cases, one line each")->callback([] {
    for (const auto& file : canonical_cases()) {
      const Case scene = read_case_file(file);
      fmt::print("{:<24} {:<12} {}\n", scene.name, scene.quasi_static ? "quasi-static" : "dynamic",
                 scene.requirement);
    }
  });
}

}  // namespace sandglass
