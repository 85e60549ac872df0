#include <fmt/format.h>

#include "app/commands.hpp"
#include "commands/workspace.hpp"
#include "io/case_file.hpp"

namespace sandglass {

void add_cases_command(CLI::App& app) {
  app.add_subcommand("cases", "list the canonical cases, one line each")->callback([] {
    for (const auto& file : canonical_files()) {
      const auto cases = read_cases(file);
      const Case& first = cases.front();
      const std::string variants = cases.size() > 1 ? fmt::format("{} variants", cases.size()) : "";
      fmt::print("{:<24} {:<12} {:<12} {}\n", first.family, first.quasi_static ? "quasi-static" : "dynamic",
                 variants, first.requirement);
    }
  });
}

}  // namespace sandglass
