#include <fmt/format.h>

#include "app/commands.hpp"
#include "assembly/method_entry.hpp"

namespace sandglass {

void add_methods_command(CLI::App& app) {
  app.add_subcommand("methods", "list the methods, one line each")->callback([] {
    for (const MethodEntry& method : methods()) {
      fmt::print("{:<24} {:<8} {}\n", method.name, method.takes_kappa ? "--kappa" : "", method.summary);
    }
  });
}

}  // namespace sandglass
